#include "core/installation_checks/internal/single_epoch_solver.h"

#include "core/base/calendar.h"

namespace leonav {
namespace {

constexpr int kMinPointSatellites = 5;  // one more than needed, so that a wrong one shows
constexpr double kMaxPdop = 10.0;
constexpr double kMaxResidualRms_m = 60.0;
constexpr int kEpochs = 5;

RobustConfig switched_on(RobustConfig robust) {
  robust.enabled = true;
  return robust;
}

// A few codes always agree with some position, so that most must agree.
bool most_codes_agree(const MeasurementEpoch& epoch) {
  int used = 0, thrown_out = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    used += is_used(measurement.reason) ? 1 : 0;
    thrown_out += measurement.reason == Reason::kOutlier ? 1 : 0;
  }
  return used > 2 * thrown_out;
}

}  // namespace

SingleEpochSolver::SingleEpochSolver(const GnssConfig& config, const RobustConfig& robust)
    : config_(config),
      robust_(switched_on(robust)),
      measurements_(std::make_unique<MeasurementEpoch>()),
      restamped_(std::make_unique<RawEpoch>()) {}

void SingleEpochSolver::clear() { unsolved_epochs_ = restamped_solved_epochs_ = 0; }

bool SingleEpochSolver::try_solve(const RawEpoch& raw, const EphemerisStore& ephemeris_store) {
  point_ = solve_point(raw, ephemeris_store, config_, robust_, Eigen::Vector3d::Zero(),
                       measurements_.get());
  return point_.status == PointStatus::kOk && point_.satellites >= kMinPointSatellites &&
         point_.pdop <= kMaxPdop && point_.residual_rms_m <= kMaxResidualRms_m &&
         point_.p_e.allFinite() && point_.covariance_p_e.allFinite() &&
         most_codes_agree(*measurements_);
}

const PointSolution* SingleEpochSolver::solve(const RawEpoch& raw,
                                              const EphemerisStore& ephemeris_store) {
  if (try_solve(raw, ephemeris_store)) {
    clear();
    return &point_;
  }
  if (++unsolved_epochs_ < kEpochs) return nullptr;
  *restamped_ = raw;
  restamped_by_s_ = leap_seconds(raw.time);
  restamped_->time = raw.time.plus_seconds(restamped_by_s_);
  restamped_solved_epochs_ =
      try_solve(*restamped_, ephemeris_store) ? restamped_solved_epochs_ + 1 : 0;
  return nullptr;
}

ConventionFinding SingleEpochSolver::evaluate() const {
  if (restamped_solved_epochs_ < kEpochs) return {};
  return {Convention::kLeapSeconds, restamped_by_s_};
}

}  // namespace leonav
