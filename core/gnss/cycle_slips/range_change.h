// This unit tests for cycle slips by geometry: the carriers of all satellites must agree on one
// change of antenna position and receiver clock.
//
// Row i, a satellite whose arc continues since the epoch before (m):
//   residual_i = (carrier_k - carrier_{k-1}) - (predicted_k - predicted_{k-1})
//              = direction_i . x + direction_change_i . p + clock + inter-system change + noise
// carrier: ionosphere-free, or one frequency; predicted: range, satellite clock and troposphere at
// the approximate positions of the two epochs; x: error of the predicted position change; p: error
// of the approximate position of the earlier epoch. A receiver clock jump is one clock change in
// this model: carriers with or without it pass equally.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "core/base/capacity.h"
#include "core/gnss/measurement/cycle_slip_config.h"

namespace leonav {

// One row i of the equation above; ECEF, m.
struct RangeChangeRow {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // d range / d antenna position, ECEF, at k
  Eigen::Vector3d direction_change = Eigen::Vector3d::Zero();  // that minus the one at k-1
  double residual_m = 0.0;
  // 1 sigma of the residual: noise of both epochs, satellite clock, orbit rate, troposphere; on one
  // frequency also the ionosphere over the interval.
  double sigma_m = 0.01;
  int system_time = 0;  // [0, kMaxSystemTimes)
};

// Prior knowledge of x and p.
struct RangeChangePrior {
  // Covariance of the predicted position change, m^2: millimetres to centimetres after inertial
  // navigation, zero when the antenna is stationary.
  Eigen::Matrix3d change_covariance = Eigen::Matrix3d::Zero();
  bool change_is_free = true;  // nothing known: the covariance is not read
  // Covariance of the approximate position at k-1, m^2. It matters where a satellite's direction
  // turns much: 10 m make 5 cm over 30 s for GNSS, 7 cm over 1 s for LEO.
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();
};

// Verdict on one row.
enum class RangeChangeVerdict : std::uint8_t {
  // There is no row, or its check is too weak: the row alone determines an unknown, or no cycle
  // would show.
  kNotTested,
  kConsistent,  // agrees with the others
  kSlipped,
  kUndecided,  // something slipped and it may be this row: other sets of slips explain all as well
  kUnclear,    // deviates by more than most noise but less than a slip's limit; no sign of any slip
};

// Verdict on the epoch.
enum class RangeChangeStatus : std::uint8_t {
  kConsistent,  // no slip
  kSlips,       // slips were found and located
  // The rows contradict each other and no unique set of slips explains it: all that may have
  // slipped are kUndecided.
  kUndecidable,
  kTooFewRows,  // no redundancy: every verdict is kNotTested
};

// Verdict on one row, with its evidence.
struct RangeChangeRowResult {
  RangeChangeVerdict verdict = RangeChangeVerdict::kNotTested;
  double deviation_m = 0.0;  // from the prediction by the other rows: the slip's size, if it is one
  double sigma_m = 0.0;      // of the deviation; 0: no other row checks this one
};

// Result of the test of one epoch.
struct RangeChangeResult {
  RangeChangeStatus status = RangeChangeStatus::kTooFewRows;
  boost::container::static_vector<RangeChangeRowResult, kMaxSatellites> rows;  // in the rows' order
  Eigen::Vector3d change_m = Eigen::Vector3d::Zero();  // x, from the rows that agree
  double clock_change_m = 0.0;
  double scale = 1.0;  // scatter of the rows that agree over their sigmas, 1 to max_scale
  int redundancy = 0;  // rows that agree minus the unknowns without a prior
};

// Decides which rows have slipped.
//
// Redundancy: one spare row shows that something slipped; two show which row did, if one did, and
// each further slip needs one more. Unknowns are the clock and, without a prior, three of position:
// one slip is located with three satellites and a tight prior, or with six satellites and none. Up
// to half of the spare rows may have slipped. Rows with a value that is not finite, a sigma that is
// not positive or a system_time out of range are kNotTested. The result is deterministic; nothing
// is allocated.
RangeChangeResult range_change(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                               const CycleSlipConfig& config);

}  // namespace leonav
