#include "tools/sim/sky/ephemeris_fit.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/earth/ellipsoid.h"
#include "core/gnss/orbits/satellite_state.h"

namespace leonav::sim {
namespace {

constexpr Eigen::Index kElements = 15;
constexpr Eigen::Index kMostElements = 17;  // with the rates of a LEO satellite
constexpr double kSampleSigma = 0.01;       // relative to the priors
// Elements of a low orbit take some hundred rounds: over minutes most of them act alike.
constexpr int kMostRounds = 300;
using Elements = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostElements, 1>;

// The order is: sqrt_a, e cos omega, e sin omega, m0 + omega, delta_n, omega0, omega_dot, i0,
// i_dot, cuc, cus, crc, crs, cic, cis, and of a LEO satellite a_dot, delta_n_dot.
Eigen::Index count_of(const Ephemeris& given) {
  return given.satellite.system == System::kLeo ? kMostElements : kElements;
}

// Returns steps that move the satellite by some metres.
Elements steps(Eigen::Index count) {
  Eigen::Matrix<double, kMostElements, 1> step;
  step << 1e-3, 1e-7, 1e-7, 1e-7, 1e-11, 1e-7, 1e-11, 1e-7, 1e-11, 1e-7, 1e-7, 1.0, 1.0, 1e-7, 1e-7,
      1e-2, 1e-12;
  return step.head(count);
}

// Returns 1 / sigma of the priors (0: none), in units of the steps. The Earth's flattening perturbs
// low satellites, and their short arcs, a hundred times more.
Elements prior_weights(bool low, Eigen::Index count) {
  Eigen::Matrix<double, kMostElements, 1> sigma;
  sigma << 0, 0, 0, 0, 2e-8, 0, 2e-8, 0, 1e-9, 2e-5, 2e-5, 500.0, 500.0, 1e-6, 1e-6, 0.01, 1e-12;
  if (low) sigma *= 100.0;
  const Elements step = steps(count);
  Elements weight = Elements::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) weight[i] = sigma[i] > 0.0 ? step[i] / sigma[i] : 0.0;
  return weight;
}

Ephemeris with_elements(const Ephemeris& given, const Elements& x) {
  Ephemeris e = given;
  e.sqrt_a = x[0];
  e.eccentricity = std::hypot(x[1], x[2]);
  e.omega = e.eccentricity > 0.0 ? std::atan2(x[2], x[1]) : 0.0;
  e.m0 = std::remainder(x[3] - e.omega, 2.0 * kPi);
  e.delta_n = x[4];
  e.omega0 = std::remainder(x[5], 2.0 * kPi);
  e.omega_dot = x[6];
  e.i0 = x[7], e.i_dot = x[8];
  e.cuc = x[9], e.cus = x[10], e.crc = x[11], e.crs = x[12], e.cic = x[13], e.cis = x[14];
  if (x.size() == kMostElements) e.a_dot = x[15], e.delta_n_dot = x[16];
  return e;
}

// Returns osculating elements at toe; for geostationary BeiDou satellites in their tilted frame.
Elements first_guess(const Ephemeris& given, OrbitState s) {
  if (is_beidou_geostationary(given.satellite)) {
    const Eigen::AngleAxisd untilt(-5.0 * kPi / 180.0, Eigen::Vector3d::UnitX());
    s = {untilt * s.p_i, untilt * s.v_i};
  }
  constexpr double gm = kEarthGravitationalConstant;
  const Eigen::Vector3d h = s.p_i.cross(s.v_i);
  const Eigen::Vector3d e = s.v_i.cross(h) / gm - s.p_i.normalized();
  const double a = 1.0 / (2.0 / s.p_i.norm() - s.v_i.squaredNorm() / gm);
  const double node = std::atan2(h.x(), -h.y());
  const Eigen::Vector3d to_node(std::cos(node), std::sin(node), 0.0);
  const Eigen::Vector3d ahead = h.normalized().cross(to_node);
  const double ex = e.dot(to_node), ey = e.dot(ahead), ecc = std::hypot(ex, ey);
  const double perigee = ecc > 0.0 ? std::atan2(ey, ex) : 0.0;
  const double latitude = std::atan2(s.p_i.dot(ahead), s.p_i.dot(to_node));
  const double anomaly = latitude - perigee;  // true anomaly
  const double E = 2.0 * std::atan2(std::sqrt(1.0 - ecc) * std::sin(0.5 * anomaly),
                                    std::sqrt(1.0 + ecc) * std::cos(0.5 * anomaly));
  const bool beidou = given.satellite.system == System::kBeidou;
  const double tow =
      given.toe.plus_nanoseconds(beidou ? kBeidouMinusGpsSeconds * kNanosecondsPerSecond : 0)
          .tow_s();
  const double rate = beidou ? 7.2921150e-5 : 7.2921151467e-5;
  Elements x = Elements::Zero(count_of(given));
  x.head<4>() << std::sqrt(a), ex, ey, E - ecc * std::sin(E) + perigee;
  x[5] = node + std::remainder(rate * tow, 2.0 * kPi);
  x[7] = std::acos(h.z() / h.norm());
  return x;
}

// Returns model minus samples, in sample sigmas, then the priors.
Eigen::VectorXd residuals(const Ephemeris& given, const Elements& x, const Elements& weights,
                          std::span<const OrbitSample> samples) {
  const Ephemeris e = with_elements(given, x);
  const auto n = static_cast<Eigen::Index>(3 * samples.size());
  Eigen::VectorXd r(n + x.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    r.segment<3>(static_cast<Eigen::Index>(3 * i)) =
        (broadcast_state(e, samples[i].time).p_e - samples[i].p_e) / kSampleSigma;
  }
  r.tail(x.size()) = weights.cwiseProduct(x.cwiseQuotient(steps(x.size())));
  return r;
}

Eigen::MatrixXd jacobian(const Ephemeris& given, const Elements& x, const Elements& weights,
                         std::span<const OrbitSample> samples) {
  const Elements step = steps(x.size());
  Eigen::MatrixXd j(static_cast<Eigen::Index>(3 * samples.size()) + x.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Elements up = x, down = x;
    up[i] += step[i];
    down[i] -= step[i];
    j.col(i) =
        0.5 * (residuals(given, up, weights, samples) - residuals(given, down, weights, samples));
  }
  return j;  // per step
}

}  // namespace

EphemerisFit fit_ephemeris(const Ephemeris& given, const OrbitState& at_toe,
                           std::span<const OrbitSample> samples) {
  const Eigen::Index count = count_of(given);
  const Elements weights = prior_weights(at_toe.p_i.norm() < 1.2e7, count), step = steps(count);
  Elements x = first_guess(given, at_toe);
  Eigen::VectorXd r = residuals(given, x, weights, samples);
  double damping = 1e-6;
  for (int round = 0; round < kMostRounds && damping < 1e6; ++round) {
    const Eigen::MatrixXd j = jacobian(given, x, weights, samples);
    Eigen::MatrixXd system(j.rows() + count, count);
    const Elements size = j.colwise().norm().transpose();
    const Elements diagonal = std::sqrt(damping) * size;
    system << j, Eigen::MatrixXd(diagonal.asDiagonal());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(system.rows());
    right.head(r.size()) = -r;
    const Elements change = system.colPivHouseholderQr().solve(right);
    const Elements next = x + change.cwiseProduct(step);
    const Eigen::VectorXd next_r = residuals(given, next, weights, samples);
    const double gain = r.squaredNorm() - next_r.squaredNorm();
    if (!(gain > 0.0)) {
      damping *= 100.0;
      continue;
    }
    x = next;
    r = next_r;
    damping = std::max(damping * 0.01, 1e-15);
    if (gain < 1e-6 * r.squaredNorm()) break;
  }
  EphemerisFit fit;
  fit.elements = with_elements(given, x);
  double sum = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double miss = kSampleSigma * r.segment<3>(static_cast<Eigen::Index>(3 * i)).norm();
    sum += miss * miss;
    fit.worst_m = std::max(fit.worst_m, miss);
  }
  fit.rms_m = std::sqrt(sum / static_cast<double>(samples.size()));
  return fit;
}

}  // namespace leonav::sim
