// This unit decodes a stream of Xsens messages to inertial measurements with their times.
//
// Source: Xsens, MT Low Level Communication Protocol Documentation (MT0101P), MTData2 (0x36).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/xsens/xsens_framer.h"

namespace leonav {

// What one message holds of time and motion, in the sensor's axes: x forward, y left, z up. A group
// that is absent, or that holds no possible value, is empty.
struct XsensMeasurement {
  using Vector = std::array<double, 3>;
  // Integrals over the interval that ends at the message's time (DeltaQ, DeltaV), corrected for
  // coning and sculling. Its length is not told.
  struct Increments {
    Vector delta_theta_rad{};  // the rotation vector of DeltaQ
    Vector delta_velocity_m_s{};
  };
  // Angular rate and specific force at the message's time (RateOfTurn, Acceleration).
  struct Rates {
    Vector angular_rate_rad_s{};
    Vector specific_force_m_s2{};
  };
  // Bits of the status word, one for each axis.
  static constexpr std::uint32_t kClippedAcceleration = 7U << 8, kClippedRate = 7U << 11;
  static constexpr std::uint32_t kSyncOut = 1U << 22;  // a pulse left the sensor at this sample

  bool is_clipped() const {
    return status && (*status & (kClippedAcceleration | kClippedRate)) != 0;
  }

  std::optional<GpsTime> utc_time;  // UtcTime as GPS time, where the sensor marks it as valid
  std::optional<std::uint32_t> sample_time_fine;    // 0.1 ms, of a clock that wraps at 2^32
  std::optional<std::uint32_t> sample_time_coarse;  // whole seconds of the same clock
  std::optional<std::uint16_t> packet_counter;
  std::optional<std::uint32_t> status;
  std::optional<double> temperature_c;
  std::optional<Increments> increments;
  std::optional<Rates> rates;
};

// The handler gets the measurements in the order of the stream.
class XsensHandler {
 public:
  virtual ~XsensHandler() = default;
  virtual void on_measurement(const XsensMeasurement& measurement) = 0;
};

// Counts of all parts of the decoder.
struct XsensCounters {
  XsensFramerCounters framer;
  std::uint64_t measurements = 0;    // with increments or rates
  std::uint64_t without_motion = 0;  // MTData2 without a pair of increments or of rates
  std::uint64_t unpaired = 0;        // MTData2 with DeltaQ alone or DeltaV alone
  std::uint64_t other_messages = 0;  // framed, but not MTData2: answers, errors, MTData
  std::uint64_t old_data = 0;        // of those, MTData (0x32), the sensors' former output
  std::uint64_t bad_lengths = 0;     // groups of another length than their kind has: left out
  std::uint64_t bad_values = 0;      // increments or rates beyond any sensor: left out
  std::uint64_t clipped = 0;         // measurements at the end of a sensor's range
};

// The decoder streams: chunks of any size, bounded memory.
class XsensDecoder {
 public:
  void feed(std::span<const std::uint8_t> bytes, XsensHandler* handler);
  // Ends the stream and decodes the bytes that a false start near the end still holds back.
  void finish(XsensHandler* handler);
  XsensCounters counters() const;

 private:
  void drain(XsensHandler* handler);
  void decode(std::span<const std::uint8_t> payload, XsensHandler* handler);

  XsensFramer framer_;
  XsensCounters counters_;
};

}  // namespace leonav
