// The state that most rows agree on, for data of which up to a third may be grossly wrong: an L1
// fit follows few errors that pull one way with much leverage, a vote of small subsets does not.
#pragma once
#include <optional>

#include "core/gnss/robust_fit.h"

namespace leonav {

struct Consensus {
  FitState change = FitState::Zero();  // to add to the state at which the rows were linearized
  double scale = 1.0;  // robust scatter of residual over sigma there, 1 to kMaxFitScale
};

// Fits a fixed number of subsets of satellites, each just large enough, improves each fit once with
// the half of the rows that lies nearest to it, and returns the one with the smallest sum of
// squared standardized residuals, each bounded (P. J. Rousseeuw and K. Van Driessen,
// Computing LTS regression for large data sets, 2006, for the subsets and the improvement; the
// bounded sum is the M-step of an MM-estimate, with the scale of the best half). `rows` not in use
// take no part. The subsets are drawn by a generator with a fixed seed: the same rows give the same
// answer. The change is zero where none was found whose bounded sum is lower than that of the rows
// as they stand by one gross error: the scale then still tells which of them are out. nullopt:
// fewer than four spare satellites.
std::optional<Consensus> find_consensus(const FitRows& rows);

// Scale of normal errors from the residuals, over sigma, of a fit of `unknowns` unknowns. The value
// taken lies past the median by half the unknowns, so that it holds for a fit through as many rows
// too, whose residuals vanish; it is set against what a least-squares fit of normal errors with
// scale 1 leaves there: the quantile, shrunk by the share of freedom left. `standardized` is
// reordered; infinite with no more values than unknowns.
using StandardizedResiduals = boost::container::static_vector<double, kMaxMeasurements>;
double robust_scale(StandardizedResiduals* standardized, std::size_t unknowns);

}  // namespace leonav
