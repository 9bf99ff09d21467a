#include "tools/sim/faults/fault_script.h"

#include <algorithm>

namespace leonav::sim {
namespace {

bool is_now(const Fault& fault, FaultKind kind, double t) {
  return fault.kind == kind && t >= fault.from_s && t < fault.to_s;
}

bool meets(const Fault& fault, SatelliteId satellite) {
  if (fault.systems.empty() && fault.satellites.empty()) return true;
  return std::ranges::find(fault.systems, satellite.system) != fault.systems.end() ||
         std::ranges::find(fault.satellites, satellite) != fault.satellites.end();
}

// The rate rises smoothly from 0 to pull_m_s within pull_time_s: the range is rate * (x^3 - x^4 /
// 2) until then, the integral of 3 x^2 - 2 x^3.
Pull spoofed(const Fault& fault, double since_s) {
  const double x = std::min(1.0, since_s / fault.pull_time_s);
  Pull pull;
  pull.rate_m_s = fault.pull_m_s * x * x * (3.0 - 2.0 * x);
  pull.range_m = fault.pull_m_s * (fault.pull_time_s * x * x * x * (1.0 - 0.5 * x) +
                                   std::max(0.0, since_s - fault.pull_time_s));
  return pull;
}

}  // namespace

bool FaultScript::is_out(SatelliteId satellite, double elevation, double t) const {
  return std::ranges::any_of(faults_, [&](const Fault& fault) {
    return is_now(fault, FaultKind::kOutage, t) && meets(fault, satellite) &&
           elevation < fault.below_elevation;
  });
}

Pull FaultScript::pull(SatelliteId satellite, double t) const {
  Pull sum;
  for (const Fault& fault : faults_) {
    if (!meets(fault, satellite)) continue;
    if (is_now(fault, FaultKind::kSatelliteClock, t)) {
      sum.range_m += fault.jump_m + fault.drift_m_s * (t - fault.from_s);
      sum.rate_m_s += fault.drift_m_s;
    } else if (is_now(fault, FaultKind::kSpoofing, t)) {
      const Pull one = spoofed(fault, t - fault.from_s);
      sum.range_m += one.range_m;
      sum.rate_m_s += one.rate_m_s;
    } else if (fault.kind == FaultKind::kSpoofing && t >= fault.to_s) {
      ++sum.breaks;
    }
  }
  return sum;
}

bool FaultScript::is_receiver_off(double t) const {
  return std::ranges::any_of(
      faults_, [&](const Fault& fault) { return is_now(fault, FaultKind::kReceiverReset, t); });
}

bool FaultScript::is_imu_missing(double t) const {
  return std::ranges::any_of(
      faults_, [&](const Fault& fault) { return is_now(fault, FaultKind::kImuGap, t); });
}

ImuSample FaultScript::saturated(const ImuSample& sample, double t) const {
  ImuSample result = sample;
  for (const Fault& fault : faults_) {
    if (!is_now(fault, FaultKind::kImuSaturation, t)) continue;
    const double angle = fault.gyro_limit * sample.interval_s();
    const double speed = fault.accel_limit * sample.interval_s();
    result.delta_theta_b = result.delta_theta_b.cwiseMax(-angle).cwiseMin(angle);
    result.delta_velocity_b = result.delta_velocity_b.cwiseMax(-speed).cwiseMin(speed);
  }
  return result;
}

double FaultScript::delay_s(Stream stream, double t) const {
  double delay = 0.0;
  for (const Fault& fault : faults_) {
    if (is_now(fault, FaultKind::kLate, t) && fault.stream == stream) delay += fault.delay_s;
  }
  return delay;
}

bool FaultScript::is_duplicate(Stream stream, double t) const {
  return std::ranges::any_of(faults_, [&](const Fault& fault) {
    return is_now(fault, FaultKind::kDuplicate, t) && fault.stream == stream;
  });
}

Eigen::Vector3d FaultScript::orbit_error_m(SatelliteId satellite, double t) const {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  for (const Fault& fault : faults_) {
    if (!is_now(fault, FaultKind::kBadOrbit, t) || !meets(fault, satellite)) continue;
    error += Eigen::Vector3d(fault.along_m, fault.cross_m, fault.radial_m);
  }
  return error;
}

bool FaultScript::has(FaultKind kind) const {
  return std::ranges::any_of(faults_, [kind](const Fault& fault) { return fault.kind == kind; });
}

}  // namespace leonav::sim
