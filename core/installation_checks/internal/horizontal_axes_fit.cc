#include "core/installation_checks/internal/horizontal_axes_fit.h"
#include "core/base/angle.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kMinForceSquares = 2.0;  // (m/s^2)^2 s, for both forward and right: a bend, a stop
constexpr double kMaxSigma = 0.1;         // 1 sigma of the map's elements
constexpr double kMinExplained = 0.6;     // least share of the forces' squares
constexpr double kLeastSize = 0.6, kMostSize = 1.5;
constexpr double kPure = 0.4;  // largest share of the other part
constexpr double kAxesWithin = 40.0 * kDegree;

struct Sums {
  double n = 0.0;
  Eigen::Vector2d f = Eigen::Vector2d::Zero(), a = Eigen::Vector2d::Zero();
  Eigen::Matrix2d ff = Eigen::Matrix2d::Zero(), fa = ff, aa = ff;

  void add(const MotionSecond& second) {
    const Eigen::Vector2d force = second.force_b.head<2>();
    const Eigen::Vector2d acceleration(second.along, second.across);
    const double w = second.seconds;
    n += w;
    f += w * force;
    a += w * acceleration;
    ff += w * force * force.transpose();
    fa += w * force * acceleration.transpose();
    aa += w * acceleration * acceleration.transpose();
  }
  void remove_means() {
    ff -= f * f.transpose() / n;
    fa -= f * a.transpose() / n;
    aa -= a * a.transpose() / n;
  }
};

bool is_dominant(double size, double other) {
  return size > kLeastSize && size < kMostSize && other < kPure * size;
}

}  // namespace

bool HorizontalAxesFit::is_turn() const { return known && is_dominant(turn_size, mirrored_size); }
bool HorizontalAxesFit::is_mirrored() const {
  return known && is_dominant(mirrored_size, turn_size);
}
bool HorizontalAxesFit::is_right() const { return is_turn() && std::abs(turn) < kAxesWithin; }

HorizontalAxesFit fit_horizontal_axes(const MotionRecord& record, double min_speed) {
  HorizontalAxesFit fit;
  Sums sums;
  for (const MotionSecond& second : record.seconds())
    if (second.has_imu && second.has_course && second.speed >= min_speed) sums.add(second);
  if (!(sums.n > 0.0)) return fit;
  sums.remove_means();
  if (!(sums.aa(0, 0) > kMinForceSquares && sums.aa(1, 1) > kMinForceSquares)) return fit;
  if (!(sums.aa.determinant() > 0.3 * sums.aa(0, 0) * sums.aa(1, 1))) return fit;
  const Eigen::Matrix2d map = sums.fa * sums.aa.inverse();
  const double explained = (map * sums.fa.transpose()).trace();
  const double left = std::max(0.0, sums.ff.trace() - explained) / (2.0 * sums.n);
  const double sigma = std::sqrt(left / std::min(sums.aa(0, 0), sums.aa(1, 1)));
  fit.known = explained > kMinExplained * sums.ff.trace() && sigma < kMaxSigma;
  const Eigen::Vector2d turned(map(0, 0) + map(1, 1), map(1, 0) - map(0, 1));
  const Eigen::Vector2d mirrored(map(0, 0) - map(1, 1), map(1, 0) + map(0, 1));
  fit.turn = std::atan2(turned.y(), turned.x());
  fit.turn_size = 0.5 * turned.norm();
  fit.mirrored = std::atan2(mirrored.y(), mirrored.x());
  fit.mirrored_size = 0.5 * mirrored.norm();
  return fit;
}

ConventionFinding check_horizontal_axes_upright(const HorizontalAxesFit& fit) {
  if (fit.is_mirrored()) {
    const double from_exchanged = std::abs(fit.mirrored - 0.5 * EIGEN_PI);
    const bool exchanged = from_exchanged < kAxesWithin;
    return {exchanged ? Convention::kForwardRightExchanged : Convention::kMirrored,
            fit.mirrored / kDegree};
  }
  if (!fit.is_turn() || fit.is_right()) return {};
  // The axes measure the world turned by fit.turn, so that they are turned by the opposite angle.
  const double mounting = -fit.turn;
  const bool backwards = std::abs(mounting) > EIGEN_PI - kAxesWithin;
  return {backwards ? Convention::kBackwards : Convention::kTurned, mounting / kDegree};
}

ConventionFinding check_horizontal_axes_upside_down(const HorizontalAxesFit& fit,
                                                    const MeanForce& force) {
  const double tilt_deg = force.tilt() / kDegree;
  if (fit.is_turn()) return {Convention::kThirdAxisUp, tilt_deg};
  if (!fit.is_mirrored()) return {};
  if (std::abs(fit.mirrored) < kAxesWithin) return {Convention::kForwardLeftUp, tilt_deg};
  if (std::abs(fit.mirrored - 0.5 * EIGEN_PI) < kAxesWithin)
    return {Convention::kRightForwardUp, tilt_deg};
  return {Convention::kThirdAxisUp, tilt_deg};
}

}  // namespace leonav
