// This header draws random numbers and subsets that are the same on every machine.
#pragma once
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace leonav {

// Generator SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number generators,
// 2014). It uses integers only and its seed is fixed, so the sequence is the same on every machine.
class RandomDraw {
 public:
  // Returns a number in [0, limit).
  std::size_t below(std::size_t limit) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>((z ^ (z >> 31)) % limit);
  }

 private:
  std::uint64_t state_ = 1;
};

// RandomSubset draws subsets of a given size.
class RandomSubset {
 public:
  // Chooses `count` of the indices [0, size); each set is equally likely. Requires count <= size <=
  // N.
  template <std::size_t N>
  void choose(std::size_t size, std::size_t count, std::bitset<N>* chosen) {
    chosen->reset();
    // Floyd's algorithm ends after `count` draws.
    for (std::size_t last = size - count; last < size; ++last) {
      const std::size_t index = draw_.below(last + 1);
      chosen->set(chosen->test(index) ? last : index);
    }
  }

 private:
  RandomDraw draw_;
};

}  // namespace leonav
