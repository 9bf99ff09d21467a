#include "tools/connect/stamps/imu_stamper.h"

#include <cmath>
#include <limits>

#include "tools/common/format.h"

namespace leonav {
namespace {

constexpr std::int64_t kHold_ns = 600 * kNanosecondsPerSecond;

}  // namespace

std::optional<GpsTime> ImuStamper::stamp(const ImuReading& reading) {
  std::optional<std::int64_t> clock_ns = reading.clock_ns;
  clock_step_s_ = reading.clock_step_s;
  if (!clock_ns && options_.rate_hz > 0.0) {
    clock_ns = std::llround(static_cast<double>(count_++) / options_.rate_hz * 1e9);
  }
  if (clock_ns) line_.add(*clock_ns, reading.arrival_ns);
  if (reading.gps_time) {
    kind_ = Kind::kGpsTime;
    if (reading.clock_ns) {
      gps_minus_clock_ns_ = reading.gps_time->nanoseconds() - *reading.clock_ns;
      last_gps_clock_ns_ = *reading.clock_ns;
    }
    return reading.gps_time;
  }
  if (!clock_ns) {
    kind_ = Kind::kNone;
    return std::nullopt;
  }
  if (gps_minus_clock_ns_) {
    const std::int64_t held_ns = *clock_ns - last_gps_clock_ns_;
    if (held_ns >= 0 && held_ns < kHold_ns) {
      kind_ = Kind::kHeldOffset;
      return GpsTime::from_nanoseconds(*clock_ns + *gps_minus_clock_ns_);
    }
    gps_minus_clock_ns_.reset();  // held too long, or the sensor has started anew
  }
  return by_line(*clock_ns, reading);
}

std::optional<GpsTime> ImuStamper::by_line(std::int64_t clock_ns, const ImuReading& reading) {
  kind_ = Kind::kNone;
  if (!line_.is_ready()) return std::nullopt;
  if (!line_.agrees(clock_ns, reading.arrival_ns)) {
    ++contradictions_;
    return std::nullopt;
  }
  const std::optional<GpsTime> arrival = gps_->at(line_.arrival_ns(clock_ns));
  if (!arrival) return std::nullopt;
  const GpsTime by_arrivals = arrival->plus_seconds(-options_.latency_s);
  if (pulses_ != nullptr) {
    if (const auto time = by_pulses(clock_ns, reading.has_pulse, by_arrivals)) return time;
  }
  kind_ = Kind::kLine;
  return by_arrivals;
}

std::optional<GpsTime> ImuStamper::by_pulses(std::int64_t clock_ns, std::optional<bool> has_pulse,
                                             GpsTime by_arrivals) {
  if (line_.steps() != steps_of_tie_) {
    steps_of_tie_ = line_.steps();
    tie_.restart();
  }
  while (const auto mark = pulses_->pop()) tie_.on_mark(*mark);
  tie_.on_reading(clock_ns, has_pulse, by_arrivals);
  if (!tie_.line().holds_at(clock_ns)) return std::nullopt;
  kind_ = Kind::kPulse;
  stamped_clock_ns_ = clock_ns;
  return tie_.line().gps_time(clock_ns);
}

double ImuStamper::sigma_s() const {
  if (kind_ == Kind::kPulse) {
    // Errors of a number that was cut off are spread evenly over its step.
    return std::hypot(tie_.line().sigma_s(stamped_clock_ns_), clock_step_s_ / std::sqrt(12.0));
  }
  if (kind_ != Kind::kLine) return std::numeric_limits<double>::quiet_NaN();
  return std::hypot(line_.sigma_s(), gps_->sigma_s());
}

std::string ImuStamper::host_text() const {
  std::string text;
  if (gps_->host_steps() > 0) {
    text = format("; the host's clock was set %llu times, the last by %.3f s",
                  static_cast<unsigned long long>(gps_->host_steps()), gps_->last_host_step_s());
  }
  if (gps_->host_is_reference() && gps_->host_is_unsynchronised())
    text += "; the host's clock is not synchronised: is the service that keeps it at UTC running?";
  return text;
}

std::string ImuStamper::text() const {
  switch (kind_) {
    case Kind::kGpsTime:
      return "stamped by the sensor's GPS time";
    case Kind::kHeldOffset:
      return "the sensor has lost GPS time; stamped by its clock as it was set";
    case Kind::kPulse:
      return format(
                 "stamped by the sensor's clock and its pulses at the receiver, 1 sigma %.3f ms, "
                 "drift %.1f ppm, %llu steps",
                 sigma_s() * 1e3, tie_.line().drift() * 1e6,
                 static_cast<unsigned long long>(steps())) +
             (tie_.line().steps() > 0 ? format(", the last by %.4f s", tie_.line().last_step_s())
                                      : "") +
             "; " + tie_.text();
    case Kind::kLine:
      return format("stamped by %s and arrivals, 1 sigma %.2f ms, drift %.1f ppm, %llu steps",
                    options_.rate_hz > 0.0 ? "count" : "the sensor's clock", sigma_s() * 1e3,
                    line_.drift() * 1e6, static_cast<unsigned long long>(line_.steps())) +
             (line_.steps() > 0 ? format(", the last by %.3f s", line_.last_step_s()) : "") +
             host_text() +
             (pulses_ == nullptr
                  ? ""
                  : "; no pulses that can be used, as in the first seconds of every run: is the "
                    "sensor's output connected to the receiver's EXTINT, and is UBX-TIM-TM2 on? " +
                        tie_.text());
    case Kind::kNone:
      break;
  }
  if (!line_.is_ready()) {
    return line_.setbacks() > 1
               ? "no stamps yet: the sensor's clock goes back again and again; is it one sensor "
                 "alone on this stream?"
               : "no stamps yet: too few readings with a clock";
  }
  return gps_->is_known()
             ? "readings contradict the clock that they had before"
             : "no stamps yet: GPS time is not known, as no receiver's epoch has come; its stream "
               "belongs into the same configuration";
}

}  // namespace leonav
