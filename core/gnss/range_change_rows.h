// The rows of one range change as its fits take them: every unknown in units of its own prior
// sigma, so that every prior is the unit matrix and a sigma of zero is no special case.
#pragma once
#include <Eigen/Core>
#include <bitset>
#include <boost/container/static_vector.hpp>
#include <span>

#include "core/gnss/range_change.h"

namespace leonav {

// Unknowns: position change, position, clock, and the offsets from it of the time bases that occur,
// in the order of their first rows.
inline constexpr int kChangePosition = 3, kChangeClock = 6, kChangeTimeBase = 7;
// Even, so that two numbers are computed at a time; those beyond the unknowns are zero.
inline constexpr int kChangeUnknowns = 12;
static_assert(kChangeTimeBase + kMaxTimeBases <= kChangeUnknowns);
using ChangeVector = Eigen::Matrix<double, kChangeUnknowns, 1>;

using ChangeSet = std::bitset<kMaxSatellites>;  // of rows

struct ChangeRow {
  ChangeVector h = ChangeVector::Zero();
  double residual = 0.0;  // m
  double sigma = 1.0;     // m
  std::size_t source = 0;
};

struct ChangeRows {
  boost::container::static_vector<ChangeRow, kMaxSatellites> rows;  // the usable ones
  int unknowns = kChangeTimeBase;                                   // the rest of each h is zero
  Eigen::Matrix3d change_root = Eigen::Matrix3d::Zero();  // from the first three unknowns to m
  double clock_unit_m = 0.0;
  double centre_m = 0.0;  // taken out of every residual
};

ChangeRows scaled_rows(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                       const CycleSlipConfig& config);

}  // namespace leonav
