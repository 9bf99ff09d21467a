#include "tools/sim/scenario/lattice_noise.h"

#include <cmath>
#include <numbers>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav::sim {

LatticeNoise::Value LatticeNoise::at(double argument) const {
  const double left = std::floor(argument), x = argument - left;
  const auto deviate = [this](double knot) {
    const auto k = static_cast<std::uint64_t>(static_cast<std::int64_t>(knot));
    // The seeds of neighbours must be far apart, because the generator steps by a constant.
    return GaussianGenerator((key_ ^ (k * 0xD1342543DE82EF95ULL)) * 0x2545F4914F6CDD1DULL).draw();
  };
  const double a = deviate(left), b = deviate(left + 1.0);
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const double angle = kQuarter * x * x * (3.0 - 2.0 * x);
  const double angle_slope = kQuarter * 6.0 * x * (1.0 - x);
  const double c = std::cos(angle), s = std::sin(angle);
  return {a * c + b * s, (b * c - a * s) * angle_slope};
}

}  // namespace leonav::sim
