// This function solves the equation of one protection level in one dimension.
//
// With hypothesis k of probability p_k, under which the estimate is off by at most b_k and has an
// error of 1 sigma s_k beside that, the level L is where the risk is used up:
//   risk = sum over k of p_k P(|error_k| > L - b_k)
// It is the multiple-hypothesis solution-separation equation of ARAIM (Blanch, Walter, Enge, Lee,
// Pervan, Rippl, Spletter, Kropp, "Baseline advanced RAIM user algorithm and possible
// improvements", IEEE TAES 51(1), 2015), with an overbound in place of the normal distribution and
// both tails under every hypothesis (docs/models/integrity.md).
#pragma once
#include <span>

#include "core/integrity/integrity_config.h"

namespace leonav {

// One hypothesis in one dimension; no fault is one of them. All lengths share one unit, m or rad.
struct LevelTerm {
  double probability = 0.0;
  double offset = 0.0;  // b_k, not negative
  double sigma = 0.0;   // s_k
};

// Returns the risk that is left at `level`.
double remaining_risk(double level, std::span<const LevelTerm> terms, const Overbound& overbound);

// Returns the smallest level at which the remaining risk is at most `risk`, to 1e-9 of itself and
// never too small. NaN if a term is not finite or the risk is not positive.
double solve_level(std::span<const LevelTerm> terms, double risk, const Overbound& overbound);

}  // namespace leonav
