#include "core/navigator/stages/internal/epoch_report.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>

#include "core/filter/state/covariance_blocks.h"
#include "core/gnss/measurement/dop.h"
#include "core/navigator/interface/filter_estimate.h"
#include "core/navigator/interface/solution_conversion.h"

namespace leonav {
namespace {

AidingReport start_aiding(const MeasurementEpoch& epoch, const Measurement& measurement) {
  AidingReport aiding;
  aiding.satellite = epoch.satellites[measurement.satellite_index].satellite;
  aiding.observable = measurement.observable;
  aiding.code = measurement.code;
  aiding.second_code = measurement.second_code;
  aiding.observation = measurement.value;
  aiding.reason = measurement.reason;
  return aiding;
}

// Reports the satellites. A satellite is used if any of its measurements was used. Otherwise it
// gets the reason of its first measurement or, without measurements, that from preprocessing.
void report_satellites(const MeasurementEpoch& epoch, EpochReport* report) {
  for (const SatelliteInView& in_view : epoch.satellites) {
    SatelliteReport satellite;
    satellite.satellite = in_view.satellite;
    satellite.reason = in_view.reason;
    if (in_view.elevation != 0.0 || in_view.azimuth != 0.0) {  // both 0: not known
      satellite.elevation = in_view.elevation;
      satellite.azimuth = in_view.azimuth;
    }
    satellite.cn0_dbhz = in_view.cn0_dbhz;
    satellite.ephemeris_age_s = in_view.ephemeris_age_s;
    satellite.source = in_view.source;
    satellite.clock_from_file = in_view.clock_from_file;
    satellite.arc = in_view.arc;
    satellite.arc_started = in_view.arc_started;
    satellite.arc_causes = in_view.arc_causes;
    const AidingReport* first = nullptr;
    bool used = false;
    for (const AidingReport& aiding : report->aiding) {
      if (aiding.satellite != in_view.satellite) continue;
      if (first == nullptr) first = &aiding;
      used = used || is_used(aiding.reason);
    }
    if (first != nullptr) satellite.reason = used ? Reason::kUsed : first->reason;
    if (used) ++report->satellites_used;
    report->satellites.push_back(satellite);
  }
}

// Reports the DOP of the satellites that were used in the end. The filter's reasons are only in the
// report, whose `aiding` holds the epoch's measurements in the same order, or the first of them.
void report_dop(const MeasurementEpoch& epoch, const Eigen::Vector3d& antenna_p_e,
                EpochReport* report) {
  std::bitset<kMaxSatellites> used;
  for (std::size_t i = 0; i < report->aiding.size(); ++i) {
    const AidingReport& aiding = report->aiding[i];
    if (aiding.observable != Observable::kCode || !is_used(aiding.reason)) continue;
    used.set(epoch.measurements[i].satellite_index);
  }
  const Dop dop = dilution_of_precision(epoch, used, antenna_p_e);
  report->pdop = dop.pdop;
  report->hdop = dop.hdop;
  report->vdop = dop.vdop;
}

}  // namespace

void start_report(std::uint64_t index, GpsTime time, bool empty, EpochReport* report) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  report->sequence = 0;
  report->index = index;
  report->time = time;
  report->empty = empty;
  report->solution = Solution();
  report->learned_errors = {};
  report->widened_predictions = 0;
  report->orbits_refused = 0;
  report->arcs_joined = 0;
  report->solution.time = time;
  report->satellites_used = 0;
  report->pdop = report->hdop = report->vdop = nan;
  report->clock_m.fill(nan);
  report->clock_drift_m_s.fill(nan);
  report->wet_delay_m = report->wet_delay_sigma_m = nan;
  report->nis = 0.0;
  report->nis_degrees = 0;
  report->satellites.clear();
  report->aiding.clear();
  report->fault_hypotheses.clear();
  report->constraints.clear();
  report->constraint_reports.clear();
}

void report_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result,
                   const Eigen::Vector3d& antenna_p_e, EpochReport* report) {
  const std::size_t reported = std::min(result.innovations.size(), epoch.measurements.size());
  for (std::size_t i = 0; i < reported; ++i) {
    const InnovationReport& innovation = result.innovations[i];
    AidingReport aiding = start_aiding(epoch, epoch.measurements[i]);
    aiding.innovation = innovation.innovation;
    aiding.innovation_variance = innovation.innovation_variance;
    aiding.residual = innovation.residual;
    aiding.test_ratio = innovation.test_ratio;
    aiding.weight_factor = innovation.weight_factor;
    aiding.reason = innovation.reason;
    report->aiding.push_back(aiding);
  }
  report->nis = result.nis;
  report->nis_degrees = result.used;
  report_satellites(epoch, report);
  report_dop(epoch, antenna_p_e, report);
}

void report_point(const MeasurementEpoch& epoch, bool solved, const Eigen::Vector3d& antenna_p_e,
                  EpochReport* report) {
  for (const Measurement& measurement : epoch.measurements) {
    AidingReport aiding = start_aiding(epoch, measurement);
    aiding.innovation_variance = measurement.sigma * measurement.sigma;
    if (!solved && is_used(aiding.reason)) aiding.reason = Reason::kNotSolved;
    if (!is_used(aiding.reason)) aiding.weight_factor = 0.0;
    report->aiding.push_back(aiding);
  }
  report_satellites(epoch, report);
  if (solved) report_dop(epoch, antenna_p_e, report);
}

void report_state(const Ekf& ekf, EpochReport* report) {
  if (!ekf.initialized()) return;
  fill_solution(ekf, &report->solution);
  report->learned_errors = ekf.learned_summary();
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    const auto i = static_cast<Eigen::Index>(system);
    if (ekf.estimate().known_clocks().offset[system])
      report->clock_m[system] = ekf.filter_state().clocks.offset_m(i);
    if (ekf.estimate().known_clocks().drift[system])
      report->clock_drift_m_s[system] = ekf.filter_state().clocks.drift_m_s(i);
  }
  const double wet_variance = wet_delay_variance(ekf.covariance());
  if (wet_variance > 0.0) {
    report->wet_delay_m = ekf.filter_state().wet_delay_m;
    report->wet_delay_sigma_m = std::sqrt(wet_variance);
  }
}

LevelGrowth report_levels(const Ekf& ekf, const IntegrityConfig& config, EpochReport* report) {
  if (!ekf.initialized()) return {};
  const NominalError error = nominal_error(ekf, report->solution);
  const FaultHypotheses& faults = report->fault_hypotheses;
  const LevelGrowth levels(error, {faults.data(), faults.size()}, config);
  set_levels(levels.at(error), &report->solution);
  return levels;
}

}  // namespace leonav
