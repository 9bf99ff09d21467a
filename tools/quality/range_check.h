// The geometric check for cycle slips over one stream of carriers, with satellites and places from
// the log itself and a motion of which nothing is known.
#pragma once
#include <map>
#include <vector>

#include "core/gnss/carrier_arcs.h"
#include "core/gnss/range_change.h"
#include "tools/quality/sky.h"

namespace leonav {

class RangeCheck {
 public:
  explicit RangeCheck(const CycleSlipConfig& config) : config_(config) {}

  // Of the epoch that `arcs` has processed: results in the order of the inputs.
  std::vector<RangeRowResult> test(const std::vector<CarrierInput>& inputs, const ArcEpoch& arcs,
                                   const Sky& sky);
  // After settle(): what the next epoch is held against.
  void remember(const std::vector<CarrierInput>& inputs, const ArcEpoch& arcs, const Sky& sky);

 private:
  struct Before {
    GpsTime time;
    std::uint32_t arc = 0;
    double residual_m = 0.0;  // carrier minus predicted
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    OrbitSource source = OrbitSource::kNone;
    std::uint32_t issue = 0;
  };

  CycleSlipConfig config_;
  GpsTime last_time_;
  double last_place_sigma_m_ = 0.0;
  std::map<SatelliteId, Before> before_;
};

}  // namespace leonav
