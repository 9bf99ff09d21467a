// The ImuStamper gives inertial readings their GPS time.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "tools/connect/stamps/envelope_line.h"
#include "tools/connect/stamps/gps_clock.h"
#include "tools/connect/stamps/imu_reading.h"
#include "tools/connect/stamps/pulse_mark.h"
#include "tools/connect/stamps/pulse_tie.h"

namespace leonav {

struct ImuStampOptions {
  // From a reading's time to the arrival of its last byte, at the least: the sensor's filter, its
  // output and the bytes on the wire. Not for readings with GPS time.
  double latency_s = 0.0;
  // Of a sensor that has no clock at all: readings are counted instead. 0: it has one.
  double rate_hz = 0.0;
};

// The best stamp that a reading allows is used:
//
// 1. GPS time, where the sensor has it;
// 2. the sensor's own clock, by its offset from GPS time as the sensor last gave it, for ten
//    minutes after a GPS time was lost;
// 3. the sensor's own clock by its pulses at a receiver (PulseTie), where there are any, until a
//    minute after the last one;
// 4. the sensor's own clock, or the count of readings, by the best line through arrivals
//    (EnvelopeLine), whose GPS time `gps` knows.
class ImuStamper {
 public:
  enum class Kind : std::uint8_t { kNone, kGpsTime, kHeldOffset, kPulse, kLine };

  // `pulses`: those of this sensor that the receiver saw; nullptr: none are connected. Both must
  // outlive this object.
  ImuStamper(const GpsClock* gps, const ImuStampOptions& options, PulseQueue* pulses = nullptr)
      : gps_(gps), options_(options), pulses_(pulses) {}

  // The end of the reading's interval; nullopt: no stamp is possible yet, or it would contradict
  // the arrival (counted in contradictions()).
  std::optional<GpsTime> stamp(const ImuReading& reading);

  Kind kind() const { return kind_; }
  double sigma_s() const;  // 1 sigma of stamps by pulses or arrivals; NaN for other kinds
  std::uint64_t contradictions() const { return contradictions_; }
  std::uint64_t steps() const { return line_.steps() + tie_.line().steps(); }
  std::string text() const;  // by what is stamped, how well, which steps: for users

 private:
  std::optional<GpsTime> by_line(std::int64_t clock_ns, const ImuReading& reading);
  std::optional<GpsTime> by_pulses(std::int64_t clock_ns, std::optional<bool> has_pulse,
                                   GpsTime by_arrivals);

  std::string host_text() const;

  const GpsClock* gps_;
  ImuStampOptions options_;
  PulseQueue* pulses_;
  EnvelopeLine line_;  // from the sensor's clock to arrival
  PulseTie tie_;
  std::uint64_t steps_of_tie_ = 0;     // of line_, that tie_ knows
  double clock_step_s_ = 0.0;          // of the last reading
  std::int64_t stamped_clock_ns_ = 0;  // of the last stamp by pulses
  std::int64_t count_ = 0;
  std::optional<std::int64_t> gps_minus_clock_ns_;
  std::int64_t last_gps_clock_ns_ = 0;  // the sensor's clock when it last had GPS time
  Kind kind_ = Kind::kNone;
  std::uint64_t contradictions_ = 0;
};

}  // namespace leonav
