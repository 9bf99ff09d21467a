// RangeTest runs the geometric test for cycle slips over one stream of carriers. Orbits and
// positions come from the log itself; the antenna's motion is taken as unknown.
#pragma once
#include <map>
#include <vector>

#include "core/gnss/cycle_slips/carrier_arcs.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "tools/quality/internal/sky.h"

namespace leonav {

// RangeTest compares the residuals of successive epochs.
class RangeTest {
 public:
  RangeTest(const CycleSlipConfig& config, const BandPlan& bands)
      : config_(config), bands_(bands) {}

  // Tests the epoch that `arcs` has processed; results are in the order of the inputs.
  std::vector<RangeChangeRowResult> test(const std::vector<CarrierInput>& inputs,
                                         const ArcEpoch& arcs, const Sky& sky);
  // Stores the epoch for the next comparison. Call it after apply_range_change().
  void remember(const std::vector<CarrierInput>& inputs, const ArcEpoch& arcs, const Sky& sky);

 private:
  // The previous epoch of one satellite.
  struct Before {
    GpsTime time;
    std::uint32_t arc = 0;
    double residual_m = 0.0;  // carrier minus predicted
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    OrbitSource source = OrbitSource::kNone;
    std::uint32_t issue = 0;
  };

  CycleSlipConfig config_;
  BandPlan bands_;
  GpsTime last_time_;
  double last_position_sigma_m_ = 0.0;
  std::map<SatelliteId, Before> before_;
};

}  // namespace leonav
