#include "core/installation_checks/installation_monitor.h"

#include <algorithm>

#include "core/base/angle.h"
#include "core/installation_checks/internal/horizontal_axes_fit.h"

namespace leonav {
namespace {

constexpr double kUpright = 45.0 * kDegree;   // limit of the third axis' tilt
constexpr double kLongStraight_s = 60.0;      // from the first second with a course to the last
constexpr int kMinMoving = 20;                // seconds with a course in that span
constexpr int kLongUpright = 100;             // seconds of accelerometer data
constexpr int kLongestStart = 180;            // seconds after which every test has had its data
constexpr int kLongest = 3600;                // seconds
constexpr double kMinAxesFitSpeed_m_s = 3.0;  // at lower speed a course is too uncertain
constexpr double kFastReverse_m_s = 30.0;     // above this, reverse is as fast as forward

bool is_down(const MeanForce& force) { return force.tilt() < kUpright; }
bool is_up(const MeanForce& force) { return force.tilt() > EIGEN_PI - kUpright; }

ConventionFinding not_down(const MeanForce& force) {
  return {is_up(force) ? Convention::kThirdAxisUp : Convention::kTilted, force.tilt() / kDegree};
}

}  // namespace

InstallationMonitor::InstallationMonitor(const GnssConfig& gnss, const RobustConfig& robust,
                                         const Eigen::Vector3d& lever_arm_b,
                                         double max_reverse_speed_m_s, Posture posture)
    : record_(posture == Posture::kInHand ? kOnFoot : kInVehicle),
      point_(gnss, robust),
      range_rates_(gnss.bands),
      code_order_(gnss.bands),
      lever_arm_(lever_arm_b),
      max_reverse_speed_m_s_(max_reverse_speed_m_s),
      posture_(posture) {}

void InstallationMonitor::clear() {
  record_.clear();
  point_.clear();
  range_rates_.clear();
  code_order_.clear();
  lever_arm_.clear();
  finished_ = false;
  seconds_ = 0;
}

void InstallationMonitor::add(const ImuSample& sample) {
  if (finished_) return;
  record_.add(sample);
  lever_arm_.add(sample);
}

ConventionFinding InstallationMonitor::end_second(const RawEpoch& raw,
                                                  const EphemerisStore& ephemeris_store,
                                                  const Eigen::Quaterniond* q_eb) {
  range_rates_.add(raw);
  const PointSolution* point = point_.solve(raw, ephemeris_store);
  if (point != nullptr) code_order_.add(raw, point_.measurements(), ephemeris_store);
  record_.end_second(raw.time, point);
  lever_arm_.end_second(raw.time, point, q_eb);
  const ConventionFinding finding = evaluate();
  if (finding || ++seconds_ >= kLongest) finished_ = true;
  return finding;
}

// The order prevents that one mistake passes for another: first the receiver's measurements, then
// the IMU's units, then its axes against the course.
ConventionFinding InstallationMonitor::evaluate() {
  if (const auto finding = point_.evaluate()) return finding;
  if (const auto finding = range_rates_.evaluate()) return finding;
  const MeanForce force = mean_force(record_);
  if (const auto finding = check_force_size(force, record_.imu_interval_s())) return finding;
  if (range_rates_.is_right()) {  // without Dopplers there is no course
    if (const auto finding = evaluate_course(force)) return finding;
    if (const auto finding = code_order_.evaluate()) return finding;
  }
  // The vehicle may stand for long. Then only the tilt is reported, because the kind of mistake
  // cannot be determined.
  const bool shown_long = posture_ == Posture::kUpright && force.seconds >= kLongUpright;
  return shown_long && !is_down(force) ? not_down(force) : ConventionFinding();
}

ConventionFinding InstallationMonitor::evaluate_course(const MeanForce& force) {
  if (!force.known() || !(force.mean_b.norm() > 0.0)) return {};
  const YawRateFit turns = fit_yaw_rate(record_, -force.mean_b.normalized());
  if (const auto finding = check_yaw_rate_axis(record_, turns)) return finding;
  if (const auto finding = check_yaw_rate_scale(turns, record_.imu_interval_s())) return finding;
  if (const auto finding = check_yaw_rate_delay(record_, force)) return finding;
  return evaluate_axes(force, turns);
}

// The vehicle may drive without turns, and it may stand for long. An IMU at rest may have lain on
// its side, a moving one does not; both must show the same tilt.
ConventionFinding InstallationMonitor::evaluate_straight(const MeanForce& force,
                                                         const YawRateFit& turns) {
  if (turns.span_s < kLongStraight_s || turns.seconds < kMinMoving || is_down(force)) return {};
  const MeanForce moving = mean_force(record_, MotionSeconds::kWithCourse);
  return is_down(moving) ? ConventionFinding() : not_down(moving);
}

// Tests up and down by the accelerometers, then by the gyros, then forward by braking and bends.
ConventionFinding InstallationMonitor::evaluate_axes(const MeanForce& force,
                                                     const YawRateFit& turns) {
  const bool down = is_down(force), up = is_up(force);
  if (!turns.follows()) return evaluate_straight(force, turns);
  if (!down && !up) return not_down(force);
  if (turns.slope < 0.0) {  // gyros and accelerometers contradict each other about down
    if (down) return {Convention::kGyroSign, turns.slope};
    return {Convention::kForceSign, -turns.slope};
  }
  const bool either_way = max_reverse_speed_m_s_ > kFastReverse_m_s;
  const HorizontalAxesFit track = fit_horizontal_axes(
      record_,
      either_way ? kMinAxesFitSpeed_m_s : std::max(kMinAxesFitSpeed_m_s, max_reverse_speed_m_s_));
  if (up) {
    const auto finding = check_horizontal_axes_upside_down(track, force);
    return finding || turns.span_s < kLongStraight_s ? finding : not_down(force);
  }
  const ConventionFinding finding = check_horizontal_axes_upright(track);
  if (finding && !(either_way && finding.convention == Convention::kBackwards)) return finding;
  if (!track.is_right()) return {};
  const ConventionFinding arm = lever_arm_.evaluate();
  finished_ = lever_arm_.is_known() && seconds_ >= kLongestStart;
  return arm;
}

}  // namespace leonav
