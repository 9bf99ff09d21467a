// This unit finds the state that most rows agree on, where up to a third of the rows may be grossly
// wrong. An L1 fit follows a few errors that pull one way with much leverage; a vote of small
// subsets does not.
#pragma once
#include <optional>

#include "core/robust/robust_fit.h"

namespace leonav {

// Result of the vote.
struct Consensus {
  FitState change = FitState::Zero();  // to add to the state at which the rows were linearized
  double scale = 1.0;  // robust scatter of residual over sigma there, 1 to kMaxFitScale
};

// Fits a fixed number of subsets of satellites, each just large enough, improves each fit once with
// the half of the rows that lies nearest to it, and returns the one with the smallest sum of
// squared standardized residuals, each bounded (P. J. Rousseeuw and K. Van Driessen, Computing LTS
// regression for large data sets, 2006, for the subsets and the improvement; the bounded sum is the
// M-step of an MM-estimate, with the scale of the best half). `rows` not in use take no part. The
// subsets are drawn by a generator with a fixed seed: the same rows give the same answer.
//
// The change is zero where no subset has a bounded sum that is lower, by one gross error, than that
// of the rows as they are; the scale then still shows which rows are outliers. Returns nullopt with
// fewer than four spare satellites.
std::optional<Consensus> find_consensus(const FitRows& rows);

// Returns the scale of normal errors from the standardized residuals (residual over sigma) of a fit
// of `unknowns` unknowns. It is an order statistic beyond the median by half the unknowns, so that
// it also holds for a fit through that many rows, whose residuals vanish. The value is divided by
// what a least-squares fit of normal errors with scale 1 leaves there: the normal quantile, reduced
// by the share of degrees of freedom. `standardized` is reordered; the result is infinite where
// there are no more values than unknowns.
using StandardizedResiduals = boost::container::static_vector<double, kMaxMeasurements>;
double robust_scale(StandardizedResiduals* standardized, std::size_t unknowns);

}  // namespace leonav
