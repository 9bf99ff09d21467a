#include "core/conventions/lone_point.h"

namespace leonav {
namespace {

constexpr int kMinSatellites = 5;  // one more than needed, so that a wrong one can be seen
constexpr double kMaxPdop = 10.0;
constexpr double kMaxResidualRms_m = 60.0;
constexpr double kLeapSeconds = 18.0;
constexpr int kEpochs = 5;

RobustConfig switched_on(RobustConfig robust) {
  robust.enabled = true;
  return robust;
}

// Any few codes agree with some position.
bool most_codes_agree(const MeasurementEpoch& epoch) {
  int used = 0, thrown_out = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    const Reason reason = measurement.reason;
    used += reason == Reason::kUsed || reason == Reason::kDownweighted ? 1 : 0;
    thrown_out += reason == Reason::kOutlier ? 1 : 0;
  }
  return used > 2 * thrown_out;
}

}  // namespace

LonePoint::LonePoint(const GnssConfig& config, const RobustConfig& robust)
    : config_(config),
      robust_(switched_on(robust)),
      measurements_(std::make_unique<MeasurementEpoch>()),
      restamped_(std::make_unique<RawEpoch>()) {}

void LonePoint::clear() { without_ = restamped_with_ = 0; }

bool LonePoint::solves(const RawEpoch& raw, const SatelliteCatalog& catalog) {
  point_ =
      solve_point(raw, catalog, config_, robust_, Eigen::Vector3d::Zero(), measurements_.get());
  return point_.status == PointStatus::kOk && point_.satellites >= kMinSatellites &&
         point_.pdop <= kMaxPdop && point_.residual_rms_m <= kMaxResidualRms_m &&
         point_.p_e.allFinite() && point_.covariance_p_e.allFinite() &&
         most_codes_agree(*measurements_);
}

const PointSolution* LonePoint::solve(const RawEpoch& raw, const SatelliteCatalog& catalog) {
  if (solves(raw, catalog)) {
    clear();
    return &point_;
  }
  if (++without_ < kEpochs) return nullptr;
  *restamped_ = raw;
  restamped_->time = raw.time.plus_seconds(kLeapSeconds);
  restamped_with_ = solves(*restamped_, catalog) ? restamped_with_ + 1 : 0;
  return nullptr;
}

ConventionFinding LonePoint::judge() const {
  if (restamped_with_ < kEpochs) return {};
  return {Convention::kLeapSeconds, kLeapSeconds};
}

}  // namespace leonav
