// LatticeNoise is random noise as a function: a value depends on its argument only, not on earlier
// calls.
#pragma once
#include <cstdint>

namespace leonav::sim {

// The noise has zero mean and standard deviation 1 everywhere, is correlated over about one unit of
// the argument, and is once continuously differentiable. At whole numbers it has normal deviates,
// hashed from the key; between two of them a mix whose squared weights add up to one.
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
