#include "drivers/ssr/orbit_correction.h"

#include <Eigen/Geometry>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

// Returns what is to be subtracted from the broadcast position at `time`.
Eigen::Vector3d displacement(const OrbitAndClock& corrections, const SatelliteState& broadcast,
                             GpsTime time) {
  const Eigen::Vector3d across = broadcast.p_e.cross(broadcast.v_e).normalized();
  const bool is_along_velocity = corrections.orbit.axes == OrbitAxes::kAlongVelocity;
  const Eigen::Vector3d along =
      is_along_velocity ? broadcast.v_e.normalized() : across.cross(broadcast.p_e.normalized());
  const Eigen::Vector3d radial =
      is_along_velocity ? along.cross(across) : broadcast.p_e.normalized();
  const Eigen::Vector3d delta =
      corrections.orbit.delta_rac_m +
      corrections.orbit.delta_rate_rac * seconds_between(time, corrections.orbit_reference);
  return radial * delta.x() + along * delta.y() + across * delta.z();
}

// Seconds of the week of BeiDou's time.
std::int64_t beidou_toe_s(const Ephemeris& e) {
  return e.toe.plus_nanoseconds(kBeidouMinusGpsSeconds * kNanosecondsPerSecond).nanoseconds() /
         kNanosecondsPerSecond % kSecondsPerWeek;
}

}  // namespace

GpsTime reference_time(const SsrMessage& message) {
  if (message.update_interval_s <= 1.0) return message.time;
  return message.time.plus_seconds(0.5 * message.update_interval_s);
}

CorrectedState apply(const OrbitAndClock& corrections, const Ephemeris& broadcast, GpsTime time) {
  constexpr double kHalf_s = 0.5;
  const GpsTime before = time.plus_seconds(-kHalf_s), after = time.plus_seconds(kHalf_s);
  const SatelliteState at = broadcast_state(broadcast, time);
  const Eigen::Vector3d displacement_rate =
      displacement(corrections, broadcast_state(broadcast, after), after) -
      displacement(corrections, broadcast_state(broadcast, before), before);
  const SsrClock& c = corrections.clock;
  const double s = seconds_between(time, corrections.clock_reference);
  CorrectedState state;
  state.satellite = broadcast.satellite;
  state.time = time;
  state.corrected_at = corrections.clock_reference;
  state.orbit_corrected_at = corrections.orbit_reference;
  state.issue = broadcast.issue;
  state.p_e = at.p_e - displacement(corrections, at, time);
  state.v_e = at.v_e - displacement_rate;
  state.clock_s =
      at.clock_s + (c.c0_m + s * (c.c1 + s * c.c2) + corrections.high_rate_clock_m) / kSpeedOfLight;
  state.clock_drift = at.clock_drift + (c.c1 + 2.0 * s * c.c2) / kSpeedOfLight;
  return state;
}

bool is_corrected_by(const Ephemeris& broadcast, const SsrOrbit& orbit, SsrService service) {
  const bool is_from_pages =
      service == SsrService::kGalileoHas || service == SsrService::kBeidouB2b;
  switch (broadcast.satellite.system) {
    case System::kGps:
      return (broadcast.issue & 0xFF) == orbit.issue;
    case System::kGalileo:
      if (is_from_pages && broadcast.message != NavigationMessage::kGalileoInav) return false;
      return (broadcast.issue & (service == SsrService::kIgs ? 0xFF : 0x3FF)) == orbit.issue;
    case System::kBeidou:
      if (is_from_pages) {
        return broadcast.message == NavigationMessage::kBeidouCnav1 &&
               broadcast.issue == orbit.issue;
      }
      if (broadcast.message == NavigationMessage::kBeidouCnav1) return false;
      return orbit.beidou_toe ? beidou_toe_s(broadcast) / 8 % 1024 == *orbit.beidou_toe
                              : beidou_toe_s(broadcast) / 720 % 240 == orbit.issue;
    case System::kLeo:
      break;
  }
  return false;
}

}  // namespace leonav
