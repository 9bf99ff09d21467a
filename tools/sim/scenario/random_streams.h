// Generators that do not depend on each other: what one draws changes nothing for the rest, so that
// another satellite or another fault leaves the noise of all others as it is.
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/motion/gaussian_generator.h"

namespace leonav::sim {

// FNV-1a over the words, mixed with the run's seed.
inline std::uint64_t stream_key(std::uint64_t seed, std::string_view what,
                                std::uint64_t number = 0) {
  std::uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  const auto mix = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 1099511628211ULL; };
  for (const char c : what) mix(static_cast<unsigned char>(c));
  for (int i = 0; i < 8; ++i) mix((number >> (8 * i)) & 0xff);
  return hash;
}

inline GaussianGenerator random_stream(std::uint64_t seed, std::string_view what,
                                       std::uint64_t number = 0) {
  return GaussianGenerator(stream_key(seed, what, number));
}

// `number` for what belongs to one signal (of at most 16) of one satellite (its place_of).
inline std::uint64_t signal_number(std::size_t satellite_place, std::size_t signal) {
  return (static_cast<std::uint64_t>(satellite_place) << 4) | signal;
}
// The same at one instant. What is drawn then depends on no other epoch: a satellite that was
// hidden for a while has the noise that it would have had anyway.
inline std::uint64_t instant_number(std::uint64_t signal, double t) {
  return (static_cast<std::uint64_t>(static_cast<std::int64_t>(t * 1e3 + 0.5)) << 16) | signal;
}

}  // namespace leonav::sim
