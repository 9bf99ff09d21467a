#include "core/conventions/convention_check.h"

#include <algorithm>

#include "core/conventions/track_check.h"

namespace leonav {
namespace {

constexpr double kDegree = EIGEN_PI / 180.0;
constexpr double kUpright = 45.0 * kDegree;  // of the third axis
constexpr double kLongStraight_s = 60.0;     // from the first second with a course to the last
constexpr int kMinMoving = 20;               // seconds with a course among them
constexpr int kLongUpright = 100;            // seconds of accelerometers
constexpr int kLongestStart = 180;           // seconds in which all that can be told is told
constexpr int kLongest = 3600;               // seconds
constexpr double kTrackSpeed_m_s = 3.0;      // too slow and a course says little
constexpr double kFastReverse_m_s = 30.0;    // beyond: in reverse as fast as forward

bool is_down(const MeanForce& force) { return force.tilt() < kUpright; }
bool is_up(const MeanForce& force) { return force.tilt() > EIGEN_PI - kUpright; }

ConventionFinding not_down(const MeanForce& force) {
  return {is_up(force) ? Convention::kThirdAxisUp : Convention::kTilted, force.tilt() / kDegree};
}

}  // namespace

ConventionCheck::ConventionCheck(const GnssConfig& gnss, const RobustConfig& robust,
                                 const Eigen::Vector3d& lever_arm_b, double max_reverse_speed_m_s,
                                 Posture posture)
    : record_(posture == Posture::kInHand ? kOnFoot : kInVehicle),
      point_(gnss, robust),
      lever_arm_(lever_arm_b),
      max_reverse_speed_m_s_(max_reverse_speed_m_s),
      posture_(posture) {}

void ConventionCheck::clear() {
  record_.clear();
  point_.clear();
  range_rates_.clear();
  code_order_.clear();
  lever_arm_.clear();
  rests_ = false;
  seconds_ = 0;
}

void ConventionCheck::add(const ImuSample& sample) {
  if (rests_) return;
  record_.add(sample);
  lever_arm_.add(sample);
}

ConventionFinding ConventionCheck::end_second(const RawEpoch& raw, const SatelliteCatalog& catalog,
                                              const Eigen::Quaterniond* q_eb) {
  range_rates_.add(raw);
  const PointSolution* point = point_.solve(raw, catalog);
  if (point != nullptr) code_order_.add(raw, point_.measurements(), catalog);
  record_.end_second(raw.time, point);
  lever_arm_.end_second(raw.time, point, q_eb);
  const ConventionFinding finding = judge();
  if (finding || ++seconds_ >= kLongest) rests_ = true;
  return finding;
}

// In the order in which one mistake makes others seem: first what the receiver measures, then the
// IMU's units, then its axes by the course.
ConventionFinding ConventionCheck::judge() {
  if (const auto finding = point_.judge()) return finding;
  if (const auto finding = range_rates_.judge()) return finding;
  const MeanForce force = mean_force(record_);
  if (const auto finding = check_force_size(force, record_.imu_interval_s())) return finding;
  if (range_rates_.is_right()) {  // without Dopplers there is no course
    if (const auto finding = judge_course(force)) return finding;
    if (const auto finding = code_order_.judge()) return finding;
  }
  // It may stand for long; then which of the mistakes it is nobody can tell.
  const bool shown_long = posture_ == Posture::kUpright && force.seconds >= kLongUpright;
  return shown_long && !is_down(force) ? not_down(force) : ConventionFinding();
}

ConventionFinding ConventionCheck::judge_course(const MeanForce& force) {
  if (!force.known() || !(force.mean_b.norm() > 0.0)) return {};
  const TurnFit turns = fit_turns(record_, -force.mean_b.normalized());
  if (const auto finding = check_turn_axis(record_, turns)) return finding;
  if (const auto finding = check_turn_size(turns, record_.imu_interval_s())) return finding;
  if (const auto finding = check_turn_time(record_, force)) return finding;
  return judge_axes(force, turns);
}

// It may never turn, as it may stand for long. What stood may have lain on its side, what moves
// does not: both must show the same.
ConventionFinding ConventionCheck::judge_straight(const MeanForce& force, const TurnFit& turns) {
  if (turns.span_s < kLongStraight_s || turns.seconds < kMinMoving || is_down(force)) return {};
  const MeanForce moving = mean_force(record_, MotionSeconds::kWithCourse);
  return is_down(moving) ? ConventionFinding() : not_down(moving);
}

// Up and down by the accelerometers, then by the gyros, then forward by braking and bends.
ConventionFinding ConventionCheck::judge_axes(const MeanForce& force, const TurnFit& turns) {
  const bool down = is_down(force), up = is_up(force);
  if (!turns.follows()) return judge_straight(force, turns);
  if (!down && !up) return not_down(force);
  if (turns.slope < 0.0) {  // about where down is the gyros contradict the accelerometers
    if (down) return {Convention::kGyroSign, turns.slope};
    return {Convention::kForceSign, -turns.slope};
  }
  const bool either_way = max_reverse_speed_m_s_ > kFastReverse_m_s;
  const TrackFit track = fit_track(
      record_, either_way ? kTrackSpeed_m_s : std::max(kTrackSpeed_m_s, max_reverse_speed_m_s_));
  if (up) {
    const auto finding = check_track_upside_down(track, force);
    return finding || turns.span_s < kLongStraight_s ? finding : not_down(force);
  }
  const ConventionFinding finding = check_track_upright(track);
  if (finding && !(either_way && finding.convention == Convention::kBackwards)) return finding;
  if (!track.is_right()) return {};
  const ConventionFinding arm = lever_arm_.judge();
  rests_ = lever_arm_.is_known() && seconds_ >= kLongestStart;
  return arm;
}

}  // namespace leonav
