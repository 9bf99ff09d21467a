// SingleEpochSolver gives the receiver's position and velocity from one epoch, independent of the
// filter.
#pragma once
#include <memory>

#include "core/gnss/positioning/point_solution.h"
#include "core/installation_checks/convention.h"

namespace leonav {

// SingleEpochSolver accepts a point solution (core/gnss/positioning) if most codes agree with it.
class SingleEpochSolver {
 public:
  SingleEpochSolver(const GnssConfig& config, const RobustConfig& robust);
  void clear();

  // Returns the solution of the epoch, valid until the next call; nullptr if most codes agree on
  // none.
  const PointSolution* solve(const RawEpoch& raw, const EphemerisStore& ephemeris_store);
  // Returns the measurements of the last solution, with elevations.
  const MeasurementEpoch& measurements() const { return *measurements_; }
  // Returns kLeapSeconds if the codes of several successive epochs do not agree as stamped, but do
  // with stamps 18 s later, which are then in UTC.
  ConventionFinding evaluate() const;

 private:
  bool try_solve(const RawEpoch& raw, const EphemerisStore& ephemeris_store);

  GnssConfig config_;
  RobustConfig robust_;
  PointSolution point_;
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<RawEpoch> restamped_;
  int unsolved_epochs_ = 0, restamped_solved_epochs_ = 0;  // epochs in a row
  double restamped_by_s_ = 0.0;                            // GPS time minus UTC
};

}  // namespace leonav
