#include "core/conventions/convention_check.h"

#include "core/conventions/force_check.h"

#include "core/conventions/track_check.h"

namespace leonav {
namespace {

constexpr double kDegree = EIGEN_PI / 180.0;
constexpr double kUpright = 45.0 * kDegree;  // of the third axis
constexpr int kLongStraight = 60;            // seconds with a course

}  // namespace

void ConventionCheck::clear() {
  record_.clear();
  told_ = false;
}

void ConventionCheck::add(const ImuSample& sample) {
  if (!told_) record_.add(sample);
}

bool ConventionCheck::is_due(GpsTime time) const { return !told_ && record_.is_due(time); }

ConventionFinding ConventionCheck::end_second(GpsTime time, const PointSolution* point) {
  if (record_.end_second(time, point) == nullptr) return {};
  const ConventionFinding finding = judge();
  told_ = static_cast<bool>(finding);
  return finding;
}

ConventionFinding ConventionCheck::judge() const {
  const MeanForce force = mean_force(record_);
  const double interval_s = record_.imu_interval_s();
  if (const auto finding = check_force_size(force, interval_s)) return finding;
  if (!force.known() || !(force.mean_b.norm() > 0.0)) return {};
  const TurnFit turns = fit_turns(record_, -force.mean_b.normalized());
  if (const auto finding = check_turn_size(turns, interval_s)) return finding;
  if (const auto finding = check_turn_elsewhere(record_, force)) return finding;
  return check_axes(force, turns);
}

// Up and down by the accelerometers, then by the gyros, then forward by braking and bends.
ConventionFinding ConventionCheck::check_axes(const MeanForce& force, const TurnFit& turns) const {
  const double tilt = force.tilt(), tilt_deg = tilt / kDegree;
  const bool down = tilt<kUpright, up = tilt> EIGEN_PI - kUpright;
  if (!turns.follows()) {
    // It may never turn; then which of the mistakes it is nobody can tell.
    if (down || turns.seconds < kLongStraight) return {};
    return {up ? Convention::kThirdAxisUp : Convention::kTilted, tilt_deg};
  }
  const bool agree = turns.slope > 0.0;  // on where down is
  if (!down && !up) return {Convention::kTilted, tilt_deg};
  if (!agree)
    return {down ? Convention::kGyroSign : Convention::kForceSign,
            down ? turns.slope : -turns.slope};
  const TrackFit track = fit_track(record_);
  if (down) return check_track_upright(track);
  if (const auto finding = check_track_upside_down(track, force)) return finding;
  if (turns.seconds < kLongStraight) return {};
  return {Convention::kThirdAxisUp, tilt_deg};
}

}  // namespace leonav
