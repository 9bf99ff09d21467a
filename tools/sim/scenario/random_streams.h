// This unit gives independent random generators for every part of a simulation. Draws from one do
// not affect the others, so that another satellite or another fault leaves the noise of all others
// unchanged.
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav::sim {

// Returns the key of a stream: FNV-1a over name and number, mixed with the run's seed.
inline std::uint64_t stream_key(std::uint64_t seed, std::string_view what,
                                std::uint64_t number = 0) {
  std::uint64_t hash = 14695981039346656037ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  const auto mix = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 1099511628211ULL; };
  for (const char c : what) mix(static_cast<unsigned char>(c));
  for (int i = 0; i < 8; ++i) mix((number >> (8 * i)) & 0xff);
  return hash;
}

// Returns the generator of a stream.
inline GaussianGenerator random_stream(std::uint64_t seed, std::string_view what,
                                       std::uint64_t number = 0) {
  return GaussianGenerator(stream_key(seed, what, number));
}

// Returns the number of one signal (of at most 16) of one satellite (its table_index_of).
inline std::uint64_t signal_number(std::size_t satellite_place, std::size_t signal) {
  return (static_cast<std::uint64_t>(satellite_place) << 4) | signal;
}
// Returns the number of a signal at one instant. What is drawn with it depends on no other epoch: a
// satellite that was hidden for a while has the same noise as if it had been visible.
inline std::uint64_t instant_number(std::uint64_t signal, double t) {
  return (static_cast<std::uint64_t>(static_cast<std::int64_t>(t * 1e3 + 0.5)) << 16) | signal;
}

}  // namespace leonav::sim
