// A Connection is a ByteSource over an Endpoint: it opens, reads, and tries again after a failure.
#pragma once
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "drivers/transport/arrival_clock.h"
#include "drivers/transport/byte_source.h"
#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/retry_wait.h"

namespace leonav {

class Connection final : public ByteSource {
 public:
  // An attempt to open that takes longer has failed.
  static constexpr std::chrono::seconds kOpenTimeout{10};
  // What waits for the other side to connect says so after this.
  static constexpr std::chrono::seconds kTellWaiting{1};
  // A connection that has brought bytes for so long works: the waits begin anew. One that always
  // breaks off at once is tried ever more rarely.
  static constexpr std::chrono::seconds kWorksAfter{5};

  Connection(boost::asio::io_context* io, const ArrivalClock* clock,
             std::unique_ptr<Endpoint> endpoint);
  void start(ByteSink* sink) override;
  void reconnect(const std::string& why) override;

 private:
  void open();
  void on_opened(const boost::system::error_code& error);
  void read();
  void on_read(const boost::system::error_code& error, std::size_t count);
  void fail(const std::string& why);

  const ArrivalClock* clock_;
  std::unique_ptr<Endpoint> endpoint_;
  boost::asio::steady_timer timer_;  // of the attempt to open, or of the wait before the next one
  ByteSink* sink_ = nullptr;
  RetryWait wait_;
  bool is_open_ = false;
  ArrivalClock::Steady::time_point opened_;
  bool has_ended_ = false;
  // Counts attempts, so that what an earlier one still calls back is ignored.
  std::uint64_t attempt_ = 0;
  // Holds the longest datagram of UDP.
  std::array<std::uint8_t, 65536> buffer_;
};

}  // namespace leonav
