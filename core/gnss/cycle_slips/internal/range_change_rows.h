// This unit scales the rows of one range change for its fits. Every unknown is in units of its own
// prior sigma, so that every prior is the unit matrix and a sigma of zero is no special case.
#pragma once
#include <Eigen/Core>
#include <bitset>
#include <boost/container/static_vector.hpp>
#include <span>

#include "core/gnss/cycle_slips/range_change.h"

namespace leonav {

// Unknowns are the position change, the position, the clock, and an offset from the clock for each
// system time that occurs, in the order of their first rows.
inline constexpr int kChangePosition = 3, kChangeClock = 6, kChangeTimeBase = 7;
// The number is even, so that two numbers are computed at a time; those beyond the unknowns are
// zero.
inline constexpr int kChangeUnknowns = 12;
static_assert(kChangeTimeBase + kMaxSystemTimes <= kChangeUnknowns);
using ChangeVector = Eigen::Matrix<double, kChangeUnknowns, 1>;

using ChangeSet = std::bitset<kMaxSatellites>;  // of rows

// One scaled row.
struct ChangeRow {
  ChangeVector h = ChangeVector::Zero();
  double residual = 0.0;  // m
  double sigma = 1.0;     // m
  std::size_t source = 0;
};

// All scaled rows of an epoch, with the scales.
struct ChangeRows {
  boost::container::static_vector<ChangeRow, kMaxSatellites> rows;  // the usable ones
  int unknowns = kChangeTimeBase;                                   // the rest of each h is zero
  Eigen::Matrix3d change_root = Eigen::Matrix3d::Zero();  // from the first three unknowns to m
  double clock_unit_m = 0.0;
  double centre_m = 0.0;  // removed from every residual
};

// Scales the usable rows.
ChangeRows scaled_rows(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                       const CycleSlipConfig& config);

}  // namespace leonav
