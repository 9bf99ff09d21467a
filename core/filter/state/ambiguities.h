// These functions add, find, remove and propagate the carrier ambiguities of a state and
// covariance.
#pragma once
#include <cstdint>

#include "core/filter/state/ekf_state.h"

namespace leonav {

inline constexpr int kNoAmbiguity = -1;

// Returns the index of an arc in `ambiguities`, or kNoAmbiguity.
int find_ambiguity(const Ambiguities& ambiguities, std::uint32_t arc);

// Appends a state with `sigma_m`, uncorrelated with all others. The table must have room.
void add_ambiguity(const Ambiguity& ambiguity, double sigma_m, Ambiguities* ambiguities,
                   EkfCovariance* covariance);

// Removes a state; those behind it move up.
void remove_ambiguity(int index, Ambiguities* ambiguities, EkfCovariance* covariance);

// Adds the random walk of every ambiguity over `dt` seconds.
void propagate_ambiguities(const Ambiguities& ambiguities, double dt, EkfCovariance* covariance);

}  // namespace leonav
