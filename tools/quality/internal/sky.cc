#include "tools/quality/internal/sky.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "core/gnss/positioning/point_solution.h"
#include "core/gnss/preprocessing/preprocess.h"

namespace leonav {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// These limits are those of the navigator for a position that its filter starts from.
constexpr double kMaxPdop = 15.0;
constexpr double kMaxResidualRms_m = 60.0;

bool is_believable(const PointSolution& point) {
  return point.status == PointStatus::kOk && point.pdop <= kMaxPdop &&
         point.residual_rms_m <= kMaxResidualRms_m && point.p_e.allFinite() &&
         point.covariance_p_e.allFinite();
}

}  // namespace

bool is_usable(Reason reason) {
  return is_used(reason) || reason == Reason::kOutlier || reason == Reason::kNotSolved;
}

bool has_direction(const SatelliteInView& satellite, bool has_position) {
  return has_position && satellite.source != OrbitSource::kNone;
}

Sky::Sky(const GnssConfig& config)
    : config_(config), ephemeris_store_(config.ephemeris_store), dop_{kNaN, kNaN, kNaN, kNaN} {}

void Sky::look(const RawEpoch& raw) {
  const PointSolution point = solve_point(raw, ephemeris_store_, config_, RobustConfig(),
                                          antenna_p_e_, epoch_.get(), &biases_);
  solved_ = is_believable(point);
  if (solved_) {
    antenna_p_e_ = point.p_e;
    position_sigma_m_ = std::sqrt(std::max(0.0, point.covariance_p_e.trace()));
  } else {
    preprocess(raw, ephemeris_store_, config_, antenna_p_e_, epoch_.get());
  }
  dop_ = {kNaN, kNaN, kNaN, kNaN};
  if (!has_position()) return;
  std::bitset<kMaxSatellites> usable;
  for (std::size_t i = 0; i < epoch_->satellites.size(); ++i)
    usable.set(i, is_usable(epoch_->satellites[i].reason));
  dop_ = dilution_of_precision(*epoch_, usable, antenna_p_e_);
}

const SatelliteInView* Sky::find(SatelliteId satellite) const {
  const auto found =
      std::find_if(epoch_->satellites.begin(), epoch_->satellites.end(),
                   [&](const SatelliteInView& view) { return view.satellite == satellite; });
  return found == epoch_->satellites.end() ? nullptr : &*found;
}

}  // namespace leonav
