// Generators that do not depend on each other: what one draws changes nothing for the rest, so that
// another satellite or another fault leaves the noise of all others as it is.
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/motion/gaussian_generator.h"

namespace leonav::sim {

// FNV-1a over the words, mixed with the run's seed.
inline GaussianGenerator random_stream(std::uint64_t seed, std::string_view what,
                                       std::uint64_t number = 0) {
  std::uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  const auto mix = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 1099511628211ULL; };
  for (const char c : what) mix(static_cast<unsigned char>(c));
  for (int i = 0; i < 8; ++i) mix((number >> (8 * i)) & 0xff);
  return GaussianGenerator(hash);
}

}  // namespace leonav::sim
