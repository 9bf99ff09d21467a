// This unit decodes a NovAtel byte stream (OEM4 to OEM7) to observations, ephemerides, ionosphere
// coefficients and inertial increments. Source: OEM7 Commands and Logs Reference Manual.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/signals/observation.h"
#include "drivers/binary/ephemeris_status.h"
#include "drivers/binary/range_epoch.h"
#include "drivers/oem7/oem7_framer.h"
#include "drivers/oem7/raw_imu.h"

namespace leonav {

// The handler gets the decoder's results in the order of the stream.
class Oem7Handler {
 public:
  virtual ~Oem7Handler() = default;
  virtual void on_epoch(const RawEpoch& epoch) = 0;
  virtual void on_ephemeris(const Ephemeris& ephemeris) = 0;
  virtual void on_klobuchar(const KlobucharModel& model) = 0;
  virtual void on_imu(const RawImuIncrements&) {}
};

// Counts of range logs that gave no epoch.
struct Oem7RangeCounters {
  std::uint64_t bad_length = 0;         // the log does not hold what it claims
  std::uint64_t without_time = 0;       // the receiver did not know the time
  std::uint64_t without_reference = 0;  // signals of RANGECMP4 whose reference was not received
};

// Counts of logs with ephemerides.
struct Oem7EphemerisCounters : EphemerisRefusals {
  std::uint64_t ephemerides = 0;     // given out
  std::uint64_t repeated = 0;        // same contents as before, or GPSEPHEM beside RAWEPHEM
  std::uint64_t without_time = 0;    // the receiver did not know the time
  std::uint64_t bad_ionosphere = 0;  // IONUTC that is too short or not finite
};

// Counts of all parts of the decoder.
struct Oem7Counters {
  Oem7FramerCounters framer;
  Oem7RangeCounters ranges;
  RangeEpochCounters epochs;
  Oem7EphemerisCounters ephemerides;
  RawImuCounters imu;
  std::uint64_t second_antenna = 0;               // logs of the second antenna
  std::uint64_t responses = 0;                    // answers to commands
  std::map<std::uint16_t, std::uint64_t> unused;  // other logs, by number
  CapacityLosses losses;                          // signals that did not fit into their epoch
};

// Returns the name of a log and, where it helps, why it is not used; its number if it is unknown.
std::string unused_log_text(std::uint16_t message_id);

// Settings of the decoder.
struct Oem7Options {
  std::optional<ImuScale> imu_scale;  // of every IMU; empty: that of its type
};

// The decoder streams: chunks of any size, no recursion, bounded memory. A range log is a whole
// epoch and given out with its last byte. An ephemeris and a set of coefficients are given out once
// per contents.
class Oem7Decoder {
 public:
  explicit Oem7Decoder(const Oem7Options& options = {});
  ~Oem7Decoder();

  void feed(std::span<const std::uint8_t> bytes, Oem7Handler* handler);
  // Ends the stream and decodes the bytes that a false sync near the end still holds back.
  void finish(Oem7Handler* handler);
  Oem7Counters counters() const;

 private:
  void drain(Oem7Handler* handler);
  void dispatch(const Oem7Message& message, Oem7Handler* handler);
  bool take_ranges(const Oem7Message& message, Oem7Handler* handler);
  bool take_navigation(const Oem7Message& message, Oem7Handler* handler);
  bool take_imu(const Oem7Message& message, Oem7Handler* handler);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
