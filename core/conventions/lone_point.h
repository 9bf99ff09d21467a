// The receiver's position and velocity by one epoch alone, as the checks want it.
#pragma once
#include <memory>

#include "core/conventions/convention.h"
#include "core/gnss/point_solution.h"

namespace leonav {

class LonePoint {
 public:
  LonePoint(const GnssConfig& config, const RobustConfig& robust);
  void clear();

  // nullptr: none that most codes agree on. Valid until the next call.
  const PointSolution* solve(const RawEpoch& raw, const SatelliteCatalog& catalog);
  // What it was solved from, with elevations.
  const MeasurementEpoch& measurements() const { return *measurements_; }
  // Where codes do not agree, epoch after epoch, but would if the epochs were stamped in UTC.
  ConventionFinding judge() const;

 private:
  bool solves(const RawEpoch& raw, const SatelliteCatalog& catalog);

  GnssConfig config_;
  RobustConfig robust_;
  PointSolution point_;
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<RawEpoch> restamped_;
  int without_ = 0, restamped_with_ = 0;  // epochs in a row
};

}  // namespace leonav
