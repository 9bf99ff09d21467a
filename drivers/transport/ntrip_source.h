// This unit makes the source that takes a stream from an NTRIP caster.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "drivers/transport/arrival_clock.h"
#include "drivers/transport/byte_source.h"

namespace boost::asio {
class io_context;
}

namespace leonav {

// Source: RTCM 10410.0 (version 1), RTCM 10410.1 (version 2).
enum class NtripVersion : std::uint8_t {
  kAuto,  // asks as version 2, takes answers of both, and asks as version 1 where that fails
  k1,
  k2,
};

struct NtripOptions {
  std::string host;  // name or address
  std::uint16_t port = 2101;
  std::string mountpoint;
  NtripVersion version = NtripVersion::kAuto;
  bool tls = false;
  std::string ca_file;           // certificates in PEM that are trusted; empty: the system's
  std::string credentials_file;  // credentials.h; empty: no user
  // Returns a line with the receiver's position for the caster, with its line end; empty: none is
  // sent.
  std::function<std::string()> position_line;
  double position_interval_s = 10.0;  // 0: once after each connection
};

// Return what is wrong with the files that the options name, with the remedy; empty: nothing.
std::string problem_of_credentials(const NtripOptions& options);
std::string problem_of_authority(const NtripOptions& options);

// The source connects when it is started, and again after each failure, with waits that grow
// (retry_wait.h); after the caster's refusal it waits half a minute. `io` and `clock` must outlive
// it. Throws FileError where a file that the options name cannot be used.
std::unique_ptr<ByteSource> make_ntrip_source(boost::asio::io_context* io,
                                              const ArrivalClock* clock,
                                              const NtripOptions& options);

}  // namespace leonav
