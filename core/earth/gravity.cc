#include "core/earth/gravity.h"

#include <cmath>

#include "core/earth/ellipsoid.h"

namespace leonav {
namespace {

constexpr double kGm = kEarthGravitationalConstant;
constexpr double kA = kEarthSemiMajorAxis;
constexpr double kB = kA * (1.0 - kEarthFlattening);
constexpr double kFocal2 = kA * kA * kEarthEccentricitySquared;  // linear eccentricity squared
constexpr double kOmega2 = kEarthRotationRate * kEarthRotationRate;
// Inside this radius (m) the normal field contains its focal disc and has no physical meaning.
constexpr double kInnerRadius = 1.0e6;

// q and q' are those of Physical Geodesy, eqs. (2-113) and (2-133), as series in t = E/u. The
// closed forms lose five digits to cancellation at the Earth's surface, where t is 0.08.
struct QFunctions {
  double q, q_prime;
};
QFunctions q_functions(double t) {
  const double t2 = t * t;
  QFunctions sum{0.0, 0.0};
  double power = t2;  // (-1)^(n+1) t^(2n)
  for (int n = 1; n <= 40; ++n) {
    const double denominator = (2.0 * n + 1.0) * (2.0 * n + 3.0);
    sum.q += 2.0 * n / denominator * power * t;
    sum.q_prime += 6.0 / denominator * power;
    power *= -t2;
    if (std::abs(power) < 1e-18 * t2) break;
  }
  return sum;
}

const double kQ0 = q_functions(std::sqrt(kFocal2) / kB).q;

Eigen::Vector3d centrifugal(const Eigen::Vector3d& p_e) {
  return {kOmega2 * p_e.x(), kOmega2 * p_e.y(), 0.0};
}

}  // namespace

Eigen::Vector3d gravity_e(const Eigen::Vector3d& p_e) {
  const double r2 = p_e.squaredNorm();
  if (r2 < kInnerRadius * kInnerRadius) {
    return centrifugal(p_e) - kGm / (kInnerRadius * kInnerRadius * kInnerRadius) * p_e;
  }
  const double p = std::hypot(p_e.x(), p_e.y());
  const double z = p_e.z();
  // Ellipsoidal coordinates u, beta (2-8, 2-9): confocal semi-minor axis and reduced latitude.
  const double d = r2 - kFocal2;
  const double u2 = 0.5 * (d + std::sqrt(d * d + 4.0 * kFocal2 * z * z));
  const double u = std::sqrt(u2);
  const double v2 = u2 + kFocal2;
  const double v = std::sqrt(v2);
  const double sb = z / u, cb = p / v;
  const double w = std::sqrt((u2 + kFocal2 * sb * sb) / v2);
  const double focal = std::sqrt(kFocal2);
  const QFunctions f = q_functions(focal / u);

  // The components along u and beta (2-132) are taken without the centrifugal part, which is added
  // exactly in ECEF.
  const double rotation = kOmega2 * kA * kA;
  const double g_u =
      -(kGm + rotation * focal * f.q_prime / kQ0 * (0.5 * sb * sb - 1.0 / 6.0)) / (v2 * w);
  const double g_beta = rotation / v * f.q / kQ0 * sb * cb / w;

  const double along_p = (u / v * cb * g_u - sb * g_beta) / w;
  const double along_z = (sb * g_u + u / v * cb * g_beta) / w;
  const double scale = p > 0.0 ? along_p / p : 0.0;
  return centrifugal(p_e) + Eigen::Vector3d(scale * p_e.x(), scale * p_e.y(), along_z);
}

Eigen::Matrix3d gravity_gradient_e(const Eigen::Vector3d& p_e) {
  const double r = std::max(p_e.norm(), kInnerRadius);
  const Eigen::Vector3d direction = p_e / r;
  Eigen::Matrix3d gradient =
      kGm / (r * r * r) * (3.0 * direction * direction.transpose() - Eigen::Matrix3d::Identity());
  gradient(0, 0) += kOmega2;
  gradient(1, 1) += kOmega2;
  return gradient;
}

}  // namespace leonav
