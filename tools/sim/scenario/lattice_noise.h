// Noise that is a function: the value at an argument depends on nothing evaluated before.
#pragma once
#include <cstdint>

namespace leonav::sim {

// Zero mean, standard deviation 1 everywhere, correlated over about one unit of the argument, once
// continuously differentiable. Normal deviates at the whole numbers, hashed from the key; between
// two of them a mix whose squared weights add up to one.
class LatticeNoise {
 public:
  LatticeNoise() = default;
  explicit LatticeNoise(std::uint64_t key) : key_(key) {}

  struct Value {
    double value, slope;
  };
  Value at(double argument) const;

 private:
  std::uint64_t key_ = 0;
};

}  // namespace leonav::sim
