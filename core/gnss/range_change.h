// The geometric check for cycle slips: the carriers of all satellites must tell one and the same
// change of antenna position and receiver clock.
//
// Row i, a satellite whose arc goes on since the epoch before (m):
//   residual_i = (carrier_k - carrier_{k-1}) - (predicted_k - predicted_{k-1})
//              = direction_i . x + direction_change_i . p + clock + inter-system change + noise
// carrier: ionosphere-free, or one frequency; predicted: range, satellite clock and troposphere at
// the approximate positions of the two epochs; x: error of the predicted position change; p: error
// of the approximate position of the earlier epoch. Receiver clock jumps are one clock change to
// this model: carriers with or without them pass alike.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <span>

#include "core/capacity.h"
#include "core/gnss/cycle_slip_config.h"

namespace leonav {

struct RangeChangeRow {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // d range / d antenna position, ECEF, at k
  Eigen::Vector3d direction_change = Eigen::Vector3d::Zero();  // that minus the one at k-1
  double residual_m = 0.0;
  double sigma_m = 0.01;  // 1 sigma of the residual: noise of both epochs, satellite clock, orbit
                          // rate, troposphere; one frequency: ionosphere over the interval as well
  int time_base = 0;      // [0, kMaxTimeBases)
};

struct RangeChangePrior {
  // Of the predicted position change, m^2: millimetres to centimetres after an inertial navigation,
  // zero when the antenna stands.
  Eigen::Matrix3d change_covariance = Eigen::Matrix3d::Zero();
  bool change_is_free = true;  // nothing known: the covariance is not read
  // Of the approximate position at k-1, m^2. Matters where a satellite's direction turns much:
  // 10 m make 5 cm over 30 s for GNSS, 7 cm over 1 s for LEO.
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Zero();
};

enum class RangeVerdict : std::uint8_t {
  kNotTested,   // no row, or nothing checks it well: a row that determines an unknown alone,
                // or with a sigma too large to tell a cycle
  kConsistent,  // agrees with the others
  kSlipped,
  kUndecided,  // something slipped and it may be this one: other slips would explain all as well
  kUnclear,    // deviates by more than noise mostly does, and by less than a slip's limit; nothing
               // says that anything slipped
};

enum class RangeChangeStatus : std::uint8_t {
  kConsistent,   // no slip
  kSlips,        // found, and which
  kUndecidable,  // rows contradict each other and no one set of slips explains it: all that may
                 // have slipped are kUndecided
  kTooFewRows,   // no redundancy: every verdict is kNotTested
};

struct RangeRowResult {
  RangeVerdict verdict = RangeVerdict::kNotTested;
  double deviation_m = 0.0;  // from what the other rows say: the slip's size, if it is one
  double sigma_m = 0.0;      // of the deviation; 0: nothing checks the row
};

struct RangeChangeResult {
  RangeChangeStatus status = RangeChangeStatus::kTooFewRows;
  boost::container::static_vector<RangeRowResult, kMaxSatellites> rows;  // in the rows' order
  Eigen::Vector3d change_m = Eigen::Vector3d::Zero();  // x, from the rows that agree
  double clock_change_m = 0.0;
  double scale = 1.0;  // scatter of the rows that agree over their sigmas, 1 to max_scale
  int redundancy = 0;  // rows that agree minus the unknowns that no prior binds
};

// Redundancy needed: one spare row to see that something slipped, two to tell which of the rows did
// if one did, and one more per further slip. Unknowns are the clock and, without a prior, three
// of position: so with a tight prior three satellites tell one slip, without it six do. Up to half
// of the spare rows may have slipped. Rows with a value that is not finite, a sigma not positive
// or a time base out of range are kNotTested. Deterministic; no allocation.
RangeChangeResult range_change(std::span<const RangeChangeRow> rows, const RangeChangePrior& prior,
                               const CycleSlipConfig& config);

}  // namespace leonav
