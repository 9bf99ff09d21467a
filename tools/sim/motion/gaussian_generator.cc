#include "tools/sim/motion/gaussian_generator.h"

#include <cmath>
#include <numbers>

namespace leonav {

double GaussianGenerator::uniform() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<double>((z >> 11) + 1) * 0x1.0p-53;
}

double GaussianGenerator::draw() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d GaussianGenerator::draw_three() {
  Eigen::Vector3d three;
  for (double& one : three) one = draw();
  return three;
}

}  // namespace leonav
