// GaussianGenerator draws random numbers that are the same with every compiler and standard
// library.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace leonav {

// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014) and the Box-Muller transform.
class GaussianGenerator {
 public:
  explicit GaussianGenerator(std::uint64_t seed) : state_(seed) {}
  double draw();                 // standard normal
  double uniform();              // (0, 1]
  Eigen::Vector3d draw_three();  // in the order x, y, z

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace leonav
