#include "tools/sim/signals/receiver.h"

#include "core/earth/tides.h"

namespace leonav::sim {

Receiver::Receiver(const Scenario& scenario, const SplineMotion& motion, const TrueSky& sky,
                   const FaultScript& faults)
    : scenario_(scenario),
      motion_(motion),
      atmosphere_(scenario),
      clock_(scenario),
      surroundings_(scenario, motion),
      multipath_(scenario),
      world_{scenario, atmosphere_, clock_, surroundings_, multipath_, faults} {
  for (const TrueSatellite& satellite : sky.satellites) observers_.emplace_back(world_, satellite);
}

void Receiver::reset() {
  for (SatelliteObserver& observer : observers_) observer.reset();
}

AntennaInstant Receiver::antenna(double t, const Eigen::Vector3d& tide_e) const {
  return antenna_at(motion_, scenario_.receiver.lever_arm_b, tide_e, t);
}

RawEpoch Receiver::epoch(double t_tag) { return epoch(t_tag, clock_.read(t_tag)); }

RawEpoch Receiver::epoch(double t_tag, const ClockReading& clock) {
  EpochInstant now;
  now.t_tag = t_tag;
  now.clock = clock;
  const GpsTime time = scenario_.start.plus_seconds(clock.t);
  now.bodies = sun_moon_positions(time);
  const Eigen::Vector3d tide_e = solid_earth_tide(motion_.at(clock.t).p_e, time, now.bodies);
  now.antenna = antenna(clock.t, tide_e);
  for (std::size_t i = 0; i < kRateTimes.size(); ++i) {
    now.around[i] = antenna(clock.t + kRateTimes[i], tide_e);
  }
  now.place = surroundings_.at(clock.t);
  RawEpoch raw;
  raw.time = scenario_.start.plus_seconds(t_tag);
  for (SatelliteObserver& observer : observers_) observer.observe(now, &raw);
  return raw;
}

}  // namespace leonav::sim
