#include "core/inertial/alignment/velocity_matching.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr std::size_t kMinEntries = 6;
constexpr double kMaxSigma = 0.35;     // rad; beyond, the angle of c is not normally distributed
constexpr double kFloor = 0.01;        // rad: vehicle and IMU are not one rigid body
constexpr double kMaxMisfit = 3.0;     // squared residuals over their variance
constexpr double kScaleSigmas = 3.0;   // |c| may differ from 1 by this many sigmas
constexpr double kScaleMargin = 0.05;  // and by this much more: second-order terms of the tilt
// m/s^2: a larger level error is corrected before the solution is repeated
constexpr double kRelevel = 0.3;

enum Unknown { kStart = 0, kTurn, kLevel, kAccelBias, kGyroBias };

std::complex<double> horizontal(const Eigen::Vector3d& v) { return {v.x(), v.y()}; }

// Returns the horizontal direction of the body's x axis.
std::complex<double> direction(const Eigen::Quaterniond& q) {
  const std::complex<double> x = horizontal(q * Eigen::Vector3d::UnitX());
  return std::abs(x) > 1e-6 ? x / std::abs(x) : 1.0;
}

}  // namespace

struct VelocityMatching::Solution {
  Eigen::Matrix<Complex, kUnknowns, 1> x = Eigen::Matrix<Complex, kUnknowns, 1>::Zero();
  double turn_variance = 0.0;  // variance of c, per component
  double misfit = 0.0;         // squared residuals over their variance, 1 if the model fits
  double seconds = 0.0;
  Eigen::Quaterniond q_last;    // body to l at the end, not levelled by the solution
  Complex off_level;            // horizontal specific force at rest in that frame, m/s^2
  double level_variance = 0.0;  // variance of off_level, per component
};

void VelocityMatching::reset() {
  current_ = Increment();
  entries_.clear();
}

void VelocityMatching::add(const ImuSample& sample) {
  const double dt = sample.interval_s();
  Increment& sum = current_;
  const Complex yaw = direction(sum.q);
  sum.rate_path += dt * (sum.bias_path + 0.5 * dt * yaw);
  sum.bias_path += dt * yaw;
  const Eigen::Quaterniond half = quaternion_from_rotation_vector(0.5 * sample.delta_theta_b);
  const Eigen::Quaterniond q_middle = sum.q * half;
  sum.velocity_b += q_middle * sample.delta_velocity_b;
  sum.q = (q_middle * half).normalized();
  sum.seconds += dt;
  rate_b_ = sample.delta_theta_b / dt;
}

bool VelocityMatching::add_velocity(const Eigen::Vector2d& v_n, double sigma_v,
                                    const Eigen::Quaterniond& q_lb) {
  if (!v_n.allFinite() || !std::isfinite(sigma_v)) return false;
  // Velocities of fast receivers are thinned out to the capacity of the window.
  const double least_s = config_.window_s / static_cast<double>(kCapacity - 4);
  if (!entries_.empty() && current_.seconds < least_s) return false;
  double length_s = current_.seconds;
  for (std::size_t i = entries_.size(); i-- > 1;) length_s += entries_[i].since.seconds;
  while (!entries_.empty() && (length_s > config_.window_s || entries_.size() == kCapacity)) {
    length_s -= entries_.size() > 1 ? entries_[1].since.seconds : length_s;
    entries_.erase(entries_.begin());
  }
  entries_.push_back({current_, q_lb, rate_b_.cross(config_.lever_arm_b), Complex(v_n.x(), v_n.y()),
                      std::hypot(sigma_v, config_.velocity_sigma)});
  current_ = Increment();
  return true;
}

// Solves the weighted least squares of the header comment; the gyros alone carry the first attitude
// along the window.
VelocityMatching::Solution VelocityMatching::solve(const Eigen::Quaterniond& first_q_lb,
                                                   double rate_sigma,
                                                   const std::optional<Heading>& known) const {
  using Row = Eigen::Matrix<Complex, kUnknowns, 1>;
  using Normal = Eigen::Matrix<Complex, kUnknowns, kUnknowns>;
  Normal information = Normal::Zero();
  const double prior[] = {
      0.0, 0.0, 1.0 / square(config_.level_sigma * kLevellingGravity),
      1.0 / square(std::max(config_.accel_bias_sigma, 1e-4)),
      1.0 / square(std::hypot(rate_sigma, kEarthRotationRate) * kLevellingGravity)};
  for (int i = 0; i < kUnknowns; ++i) information(i, i) = prior[i];
  Row right = Row::Zero();
  double observed = 0.0;
  Solution solution;
  Eigen::Quaterniond q = first_q_lb;
  Complex velocity, bias_path, tilt_path;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (i > 0) {
      const Complex yaw = direction(q);
      tilt_path += bias_path * entry.since.seconds + yaw * entry.since.rate_path;
      bias_path += yaw * entry.since.bias_path;
      velocity += horizontal(q * entry.since.velocity_b);
      q = (q * entry.since.q).normalized();
      solution.seconds += entry.since.seconds;
    }
    const Complex turned = velocity + horizontal(q * entry.swing_b);
    // The row is conjugated, as the normal equations need it.
    const Row row = Row(1.0, turned, solution.seconds, bias_path, tilt_path).conjugate();
    const double weight = 1.0 / square(entry.sigma_v);
    information += weight * row * row.adjoint();
    right += weight * row * entry.v_n;
    observed += weight * std::norm(entry.v_n);
  }
  q = (q * current_.q).normalized();  // since the last entry
  if (known) {
    const double weight = 1.0 / square(known->sigma);
    const Complex turn = std::polar(1.0, known->heading) / direction(q);
    information(kTurn, kTurn) += weight;
    right(kTurn) += weight * turn;
    observed += weight;
  }
  const Eigen::LDLT<Normal> factor(information);
  solution.x = factor.solve(right);
  solution.turn_variance = factor.solve(Row::Unit(kTurn))(kTurn).real();
  const double cost = observed - right.dot(solution.x).real();
  const double freedom = 2.0 * (static_cast<double>(entries_.size()) - (known ? 1.0 : 2.0));
  solution.misfit = std::max(0.0, cost) / freedom;
  // A gyro bias has tilted the level along the window.
  Row level = Row::Unit(kLevel);
  level(kGyroBias) = bias_path;
  solution.off_level = -(level.transpose() * solution.x)(0) / solution.x(kTurn);
  solution.level_variance = level.conjugate().dot(factor.solve(level.conjugate())).real();
  solution.q_last = q;
  return solution;
}

// Returns the rotation that levels again a frame in which the specific force at rest is `off`
// (m/s^2) horizontally.
Eigen::Quaterniond level_again(const std::complex<double>& off) {
  const Eigen::Vector3d rest(off.real(), off.imag(), -kLevellingGravity);
  return Eigen::Quaterniond::FromTwoVectors(rest, -Eigen::Vector3d::UnitZ());
}

std::optional<VelocityMatching::Match> VelocityMatching::match(
    double rate_sigma, const std::optional<Heading>& known) const {
  if (entries_.size() < kMinEntries) return std::nullopt;
  Solution solution = solve(entries_.front().q_lb, rate_sigma, known);
  const Complex off = -solution.x[kLevel] / solution.x[kTurn];
  if (std::abs(solution.x[kTurn]) > 0.5 && std::abs(off) > kRelevel)
    solution = solve(level_again(off) * entries_.front().q_lb, rate_sigma, known);

  const double scale = std::abs(solution.x[kTurn]);
  const double excess = std::max(1.0, solution.misfit);
  const double sigma_c = std::sqrt(solution.turn_variance * excess);
  const double scale_limit =
      kScaleMargin + kScaleSigmas * std::hypot(sigma_c, config_.accel_scale_sigma);
  if (!(solution.misfit < kMaxMisfit) || !(std::abs(scale - 1.0) < scale_limit))
    return std::nullopt;
  // The changes of velocity may all have happened at the window's beginning.
  const double drift = rate_sigma * solution.seconds;
  Match match;
  match.heading.sigma = std::hypot(std::hypot(sigma_c / scale, drift), kFloor);
  if (!(match.heading.sigma < kMaxSigma)) return std::nullopt;
  match.heading.heading =
      wrap_to_pi(std::arg(direction(solution.q_last)) + std::arg(solution.x[kTurn]));
  match.q_lb = level_again(solution.off_level) * solution.q_last;
  match.level_sigma =
      std::hypot(std::sqrt(solution.level_variance * excess) / kLevellingGravity, kFloor);
  match.misfit = solution.misfit;
  return match;
}

}  // namespace leonav
