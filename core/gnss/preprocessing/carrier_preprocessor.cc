#include "core/gnss/preprocessing/carrier_preprocessor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/square.h"
#include "core/gnss/measurement/range_model.h"
#include "core/gnss/preprocessing/internal/carrier_correction.h"

namespace leonav {
namespace {

// A satellite out of sight for longer starts with a new history.
constexpr double kHistoryTimeout_s = 600.0;

}  // namespace

CarrierPreprocessor::CarrierPreprocessor(const CycleSlipConfig& config, const BandPlan& bands)
    : config_(config), bands_(bands), arcs_(config, bands) {}

void CarrierPreprocessor::begin(GpsTime time) {
  time_ = time;
  inputs_.clear();
}

const CarrierPairCodes* CarrierPreprocessor::tracked_pair(SatelliteId satellite) const {
  const CarrierHistory* history = history_of(satellite);
  if (history == nullptr || !history->offered.is_set()) return nullptr;
  const double limit_s = arcs_.gap_limit_s(satellite.system, time_);
  return seconds_between(time_, history->offered) <= limit_s ? &history->pair : nullptr;
}

void CarrierPreprocessor::add_carrier(const CarrierChoice& choice, double elevation) {
  if (inputs_.size() == inputs_.capacity()) return;
  inputs_.push_back({choice.first, choice.second, elevation});
  CarrierHistory* history = history_of(choice.first->satellite);
  if (history == nullptr) return;
  history->offered = choice.second == nullptr ? GpsTime() : time_;
  if (choice.second != nullptr) history->pair = {choice.first->code, choice.second->code};
}

const ArcEpoch& CarrierPreprocessor::update_arcs() {
  arcs_.process(time_, {inputs_.data(), inputs_.size()}, &arc_epoch_);
  return arc_epoch_;
}

CarrierPreprocessor::CarrierHistory* CarrierPreprocessor::history_of(SatelliteId satellite) {
  const auto found =
      std::find_if(histories_.begin(), histories_.end(),
                   [&](const CarrierHistory& m) { return m.satellite == satellite; });
  return found == histories_.end() ? nullptr : &*found;
}

const CarrierPreprocessor::CarrierHistory* CarrierPreprocessor::history_of(
    SatelliteId satellite) const {
  return const_cast<CarrierPreprocessor*>(this)->history_of(satellite);
}

std::uint32_t CarrierPreprocessor::last_issue(SatelliteId satellite) const {
  const CarrierHistory* history = history_of(satellite);
  return history == nullptr ? 0 : history->issue;
}

double CarrierPreprocessor::last_wind_up(SatelliteId satellite) const {
  const CarrierHistory* history = history_of(satellite);
  return history == nullptr ? 0.0 : history->wind_up_cycles;
}

void CarrierPreprocessor::set_wind_up(SatelliteId satellite, double cycles) {
  CarrierHistory* history = history_of(satellite);
  if (history == nullptr) {
    if (histories_.size() == histories_.capacity()) return;
    histories_.push_back({});
    history = &histories_.back();
    history->satellite = satellite;
  }
  history->wind_up_cycles = cycles;
  history->seen = time_;
}

RangeChangeRow CarrierPreprocessor::row_of(const SatelliteInView& satellite,
                                           const Measurement& carrier, const CarrierHistory& before,
                                           const Eigen::Vector3d& predicted_p_e) const {
  const RangePrediction range = predict_range(satellite, predicted_p_e);
  const double dt = seconds_between(time_, last_time_);
  RangeChangeRow row;
  row.direction = range.d_range_d_p.transpose();
  row.direction_change = row.direction - before.direction;
  // Known steps by other elements, antenna patterns and coefficients of the ionosphere are removed.
  row.residual_m = carrier.value - range.range_m - before.residual_m;
  if (before.issue != satellite.orbit_issue) row.residual_m -= satellite.orbit_step_m;
  row.residual_m += antenna_step_m(satellite, before);
  row.residual_m -= ionosphere_step_m(satellite, before);
  row.sigma_m =
      std::sqrt(square(carrier.sigma) + before.variance_m2 +
                square(change_sigma_m(config_, bands_, satellite, carrier, predicted_p_e, dt)));
  row.system_time = static_cast<int>(index_of(satellite.satellite.system));
  return row;
}

// Returns whether the carrier can be tested against the stored one: the arc is the same, the stored
// one is of the last epoch, and the difference of the orbits is known.
bool CarrierPreprocessor::is_comparable(const SatelliteInView& satellite,
                                        const Measurement& carrier,
                                        const CarrierHistory* before) const {
  return before != nullptr && before->time == last_time_ && carrier.arc != 0 &&
         before->arc == carrier.arc &&
         (before->issue == satellite.orbit_issue || std::isfinite(satellite.orbit_step_m));
}

void CarrierPreprocessor::check_range_changes(const Eigen::Vector3d& predicted_p_e,
                                              const RangeChangePrior& prior,
                                              MeasurementEpoch* epoch) {
  change_rows_.clear();
  predicted_p_e_ = predicted_p_e;
  boost::container::static_vector<Measurement*, kMaxSatellites> carriers;
  // Statuses are in the order of add_carrier(), and so are the carriers, but some may be missing.
  std::size_t status = 0;
  boost::container::static_vector<std::size_t, kMaxSatellites> row_status;
  for (Measurement& carrier : epoch->measurements) {
    if (carrier.observable != Observable::kCarrier) continue;
    const SatelliteInView& satellite = epoch->satellites[carrier.satellite_index];
    while (status < inputs_.size() && inputs_[status].first->satellite != satellite.satellite)
      ++status;
    if (status >= inputs_.size()) break;
    carriers.push_back(&carrier);
    row_status.push_back(status);
  }
  boost::container::static_vector<RangeChangeRowResult, kMaxSatellites> verdicts(inputs_.size());
  if (last_time_.is_set() && config_.use_range_change) {
    boost::container::static_vector<std::size_t, kMaxSatellites> of_row;
    for (std::size_t i = 0; i < carriers.size(); ++i) {
      const SatelliteInView& satellite = epoch->satellites[carriers[i]->satellite_index];
      const CarrierHistory* before = history_of(satellite.satellite);
      if (!is_comparable(satellite, *carriers[i], before)) continue;
      change_rows_.push_back(row_of(satellite, *carriers[i], *before, predicted_p_e));
      of_row.push_back(row_status[i]);
    }
    const RangeChangeResult result =
        range_change({change_rows_.data(), change_rows_.size()}, prior, config_);
    for (std::size_t i = 0; i < of_row.size(); ++i) verdicts[of_row[i]] = result.rows[i];
  }
  arcs_.apply_range_change({verdicts.data(), verdicts.size()}, &arc_epoch_);
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    SatelliteInView& satellite = epoch->satellites[carriers[i]->satellite_index];
    const CarrierStatus& now = arc_epoch_.satellites[row_status[i]];
    carriers[i]->arc = satellite.arc = now.arc;
    satellite.arc_started = now.started;
    satellite.arc_causes = now.causes;
  }
  set_disturbances(epoch);
}

std::optional<AntennaChange> CarrierPreprocessor::antenna_change(RangeChangePrior prior) const {
  prior.change_is_free = true;
  const RangeChangeResult result =
      range_change({change_rows_.data(), change_rows_.size()}, prior, config_);
  if (result.redundancy < 1) return std::nullopt;
  return AntennaChange{last_time_, time_, predicted_p_e_ - last_p_e_ + result.change_m};
}

// Returns the step of the carrier's correction by other antenna patterns. Where the source of the
// orbit changes, centre of mass and phase centre change with it, which is no step.
double CarrierPreprocessor::antenna_step_m(const SatelliteInView& satellite,
                                           const CarrierHistory& before) const {
  if (before.antenna_issue == satellite.antenna_issue || before.source != satellite.source)
    return 0.0;
  return satellite.antenna_m - before.antenna_m;
}

// Returns the step of the carrier's correction by other coefficients of the ionosphere's model. It
// contains by how much the modelled delay has changed since, millimetres a second.
double CarrierPreprocessor::ionosphere_step_m(const SatelliteInView& satellite,
                                              const CarrierHistory& before) const {
  if (before.ionosphere_issue == satellite.ionosphere_issue) return 0.0;
  return satellite.carrier_ionosphere_m - before.ionosphere_m;
}

// Sets the disturbances. Another orbit, and another model of the ionosphere, has another error.
// Other antenna patterns have other corrections: the arc's constant has absorbed the difference so
// far and, as far as no clock of a system could, so has the position.
void CarrierPreprocessor::set_disturbances(MeasurementEpoch* epoch) const {
  constexpr double kDilution = 2.0;  // from errors of the satellites to the position
  std::array<double, kSystemCount> sum{}, squares{};
  std::array<int, kSystemCount> count{};
  for (Measurement& carrier : epoch->measurements) {
    if (carrier.observable != Observable::kCarrier) continue;
    const SatelliteInView& satellite = epoch->satellites[carrier.satellite_index];
    const std::size_t system = index_of(satellite.satellite.system);
    ++count[system];
    const CarrierHistory* before = history_of(satellite.satellite);
    if (before == nullptr || before->arc != carrier.arc) continue;
    const double step_m = antenna_step_m(satellite, *before);
    sum[system] += step_m;
    squares[system] += square(step_m);
    const bool same_orbit = before->issue == satellite.orbit_issue;
    const double orbit_m =
        same_orbit ? 0.0 : std::hypot(before->orbit_sigma_m, satellite.orbit_sigma_m);
    carrier.disturbance_m = std::hypot(orbit_m, step_m, ionosphere_step_m(satellite, *before));
  }
  double about_mean = 0.0;
  int carriers = 0;
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    if (count[i] == 0) continue;
    about_mean += std::max(0.0, squares[i] - square(sum[i]) / count[i]);
    carriers += count[i];
  }
  epoch->position_disturbance_m =
      carriers == 0 ? 0.0 : kDilution * std::sqrt(about_mean / carriers);
}

void CarrierPreprocessor::store_epoch(const MeasurementEpoch& epoch,
                                      const Eigen::Vector3d& antenna_p_e) {
  // Without a carrier in this epoch the stored carriers are still the last ones.
  if (std::none_of(epoch.measurements.begin(), epoch.measurements.end(),
                   [](const Measurement& m) { return m.observable == Observable::kCarrier; }))
    return;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier) continue;
    const SatelliteInView& satellite = epoch.satellites[carrier.satellite_index];
    CarrierHistory* history = history_of(satellite.satellite);
    if (history == nullptr) continue;  // the table was full
    const RangePrediction range = predict_range(satellite, antenna_p_e);
    history->time = epoch.time;
    history->arc = carrier.arc;
    history->residual_m = carrier.value - range.range_m;
    history->direction = range.d_range_d_p.transpose();
    history->variance_m2 = square(carrier.sigma);
    history->issue = satellite.orbit_issue;
    history->orbit_sigma_m = satellite.orbit_sigma_m;
    history->source = satellite.source;
    history->antenna_issue = satellite.antenna_issue;
    history->antenna_m = satellite.antenna_m;
    history->ionosphere_issue = satellite.ionosphere_issue;
    history->ionosphere_m = satellite.carrier_ionosphere_m;
  }
  last_time_ = epoch.time;
  last_p_e_ = antenna_p_e;
  histories_.erase(std::remove_if(histories_.begin(), histories_.end(),
                                  [&](const CarrierHistory& m) {
                                    return seconds_between(epoch.time, m.seen) > kHistoryTimeout_s;
                                  }),
                   histories_.end());
}

void CarrierPreprocessor::reset() {
  arcs_.reset();
  histories_.clear();
  last_time_ = GpsTime();
}

void CarrierPreprocessor::end_arc(SatelliteId satellite, MeasurementEpoch* epoch) {
  const CarrierStatus now = arcs_.end_arc(satellite, SlipCause::kFilter);
  if (now.arc == 0) return;
  for (SatelliteInView& seen : epoch->satellites) {
    if (seen.satellite != satellite) continue;
    seen.arc = now.arc;
    seen.arc_started = now.started;
    seen.arc_causes = now.causes;
  }
}

}  // namespace leonav
