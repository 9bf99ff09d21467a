// This function bounds a probability from above by how often the event was seen (Clopper and
// Pearson, "The use of confidence or fiducial limits illustrated in the case of the binomial",
// Biometrika 26(4), 1934).
#pragma once
#include <cstddef>

namespace leonav {

// Returns the smallest probability that is refuted by `events` of `trials` independent trials: with
// it, as few events or fewer have the probability 1 - confidence. 1 without trials.
double upper_bound_of_share(std::size_t events, std::size_t trials, double confidence = 0.95);

}  // namespace leonav
