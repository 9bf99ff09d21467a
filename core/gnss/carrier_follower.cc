#include "core/gnss/carrier_follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/gnss/carrier_correction.h"
#include "core/gnss/range_model.h"

namespace leonav {
namespace {

constexpr double kForget_s = 600.0;  // a satellite out of sight for longer begins anew

double square(double x) { return x * x; }

}  // namespace

CarrierFollower::CarrierFollower(const CycleSlipConfig& config) : config_(config), arcs_(config) {}

void CarrierFollower::begin(GpsTime time) {
  time_ = time;
  inputs_.clear();
}

const CarrierPairCodes* CarrierFollower::followed_pair(SatelliteId satellite) const {
  const Memory* memory = memory_of(satellite);
  if (memory == nullptr || !memory->offered.is_set()) return nullptr;
  const double limit_s = arcs_.gap_limit_s(satellite.system, time_);
  return seconds_between(time_, memory->offered) <= limit_s ? &memory->pair : nullptr;
}

void CarrierFollower::offer(const CarrierChoice& choice, double elevation) {
  if (inputs_.size() == inputs_.capacity()) return;
  inputs_.push_back({choice.first, choice.second, elevation});
  Memory* memory = memory_of(choice.first->satellite);
  if (memory == nullptr) return;
  memory->offered = choice.second == nullptr ? GpsTime() : time_;
  if (choice.second != nullptr) memory->pair = {choice.first->code, choice.second->code};
}

const ArcEpoch& CarrierFollower::follow() {
  arcs_.process(time_, {inputs_.data(), inputs_.size()}, &arc_epoch_);
  return arc_epoch_;
}

CarrierFollower::Memory* CarrierFollower::memory_of(SatelliteId satellite) {
  const auto place = std::find_if(memory_.begin(), memory_.end(),
                                  [&](const Memory& m) { return m.satellite == satellite; });
  return place == memory_.end() ? nullptr : &*place;
}

const CarrierFollower::Memory* CarrierFollower::memory_of(SatelliteId satellite) const {
  return const_cast<CarrierFollower*>(this)->memory_of(satellite);
}

std::uint32_t CarrierFollower::last_issue(SatelliteId satellite) const {
  const Memory* memory = memory_of(satellite);
  return memory == nullptr ? 0 : memory->issue;
}

double CarrierFollower::last_wind_up(SatelliteId satellite) const {
  const Memory* memory = memory_of(satellite);
  return memory == nullptr ? 0.0 : memory->wind_up_cycles;
}

void CarrierFollower::set_wind_up(SatelliteId satellite, double cycles) {
  Memory* memory = memory_of(satellite);
  if (memory == nullptr) {
    if (memory_.size() == memory_.capacity()) return;
    memory_.push_back({});
    memory = &memory_.back();
    memory->satellite = satellite;
  }
  memory->wind_up_cycles = cycles;
  memory->seen = time_;
}

RangeChangeRow CarrierFollower::row_of(const SatelliteInView& satellite, const Measurement& carrier,
                                       const Memory& before,
                                       const Eigen::Vector3d& predicted_p_e) const {
  const RangePrediction range = predict_range(satellite, predicted_p_e);
  const double dt = seconds_between(time_, last_time_);
  RangeChangeRow row;
  row.direction = range.d_range_d_p.transpose();
  row.direction_change = row.direction - before.direction;
  // Less what other elements and other antenna patterns are known to have added.
  row.residual_m = carrier.value - range.range_m - before.residual_m;
  if (before.issue != satellite.orbit_issue) row.residual_m -= satellite.orbit_step_m;
  row.residual_m += antenna_step_m(satellite, before);
  row.sigma_m = std::sqrt(square(carrier.sigma) + before.variance_m2 +
                          square(change_sigma_m(config_, satellite, carrier, dt)));
  row.time_base = static_cast<int>(index_of(satellite.satellite.system));
  return row;
}

// Whether the carrier can be tested against what was remembered: one arc, since the last epoch, of
// orbits whose difference is known.
bool CarrierFollower::is_comparable(const SatelliteInView& satellite, const Measurement& carrier,
                                    const Memory* before) const {
  return before != nullptr && before->time == last_time_ && carrier.arc != 0 &&
         before->arc == carrier.arc &&
         (before->issue == satellite.orbit_issue || std::isfinite(satellite.orbit_step_m));
}

void CarrierFollower::check_range_changes(const Eigen::Vector3d& predicted_p_e,
                                          const RangeChangePrior& prior, MeasurementEpoch* epoch) {
  change_rows_.clear();
  predicted_p_e_ = predicted_p_e;
  boost::container::static_vector<Measurement*, kMaxSatellites> carriers;
  // Statuses stand in the order of the offers, and so do the carriers, but some may be missing.
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
  boost::container::static_vector<RangeRowResult, kMaxSatellites> verdicts(inputs_.size());
  if (last_time_.is_set() && config_.use_range_change) {
    boost::container::static_vector<std::size_t, kMaxSatellites> of_row;
    for (std::size_t i = 0; i < carriers.size(); ++i) {
      const SatelliteInView& satellite = epoch->satellites[carriers[i]->satellite_index];
      const Memory* before = memory_of(satellite.satellite);
      if (!is_comparable(satellite, *carriers[i], before)) continue;
      change_rows_.push_back(row_of(satellite, *carriers[i], *before, predicted_p_e));
      of_row.push_back(row_status[i]);
    }
    const RangeChangeResult result =
        range_change({change_rows_.data(), change_rows_.size()}, prior, config_);
    for (std::size_t i = 0; i < of_row.size(); ++i) verdicts[of_row[i]] = result.rows[i];
  }
  arcs_.settle({verdicts.data(), verdicts.size()}, &arc_epoch_);
  for (std::size_t i = 0; i < carriers.size(); ++i) {
    SatelliteInView& satellite = epoch->satellites[carriers[i]->satellite_index];
    const CarrierStatus& now = arc_epoch_.satellites[row_status[i]];
    carriers[i]->arc = satellite.arc = now.arc;
    satellite.arc_started = now.started;
    satellite.arc_causes = now.causes;
  }
  disturb(epoch);
}

std::optional<AntennaChange> CarrierFollower::antenna_change(RangeChangePrior prior) const {
  prior.change_is_free = true;
  const RangeChangeResult result =
      range_change({change_rows_.data(), change_rows_.size()}, prior, config_);
  if (result.redundancy < 1) return std::nullopt;
  return AntennaChange{last_time_, time_, predicted_p_e_ - last_p_e_ + result.change_m};
}

// What other antenna patterns add to the carrier's correction. Where the source of the orbit is
// another, centre of mass and phase centre change places together with it: that is no step.
double CarrierFollower::antenna_step_m(const SatelliteInView& satellite,
                                       const Memory& before) const {
  if (before.antenna_issue == satellite.antenna_issue || before.source != satellite.source)
    return 0.0;
  return satellite.antenna_m - before.antenna_m;
}

// Another orbit has another error. Other antenna patterns correct by something else, which the
// arc's constant has taken up so far and, as far as no clock of a system could, the position.
void CarrierFollower::disturb(MeasurementEpoch* epoch) const {
  constexpr double kDilution = 2.0;  // of what is wrong with the satellites, in the position
  std::array<double, kSystemCount> sum{}, squares{};
  std::array<int, kSystemCount> count{};
  for (Measurement& carrier : epoch->measurements) {
    if (carrier.observable != Observable::kCarrier) continue;
    const SatelliteInView& satellite = epoch->satellites[carrier.satellite_index];
    const std::size_t system = index_of(satellite.satellite.system);
    ++count[system];
    const Memory* before = memory_of(satellite.satellite);
    if (before == nullptr || before->arc != carrier.arc) continue;
    const double step_m = antenna_step_m(satellite, *before);
    sum[system] += step_m;
    squares[system] += square(step_m);
    const bool same_orbit = before->issue == satellite.orbit_issue;
    const double orbit_m =
        same_orbit ? 0.0 : std::hypot(before->orbit_sigma_m, satellite.orbit_sigma_m);
    carrier.disturbance_m = std::hypot(orbit_m, step_m);
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

void CarrierFollower::remember(const MeasurementEpoch& epoch, const Eigen::Vector3d& antenna_p_e) {
  // What was remembered is still the last that carriers told.
  if (std::none_of(epoch.measurements.begin(), epoch.measurements.end(),
                   [](const Measurement& m) { return m.observable == Observable::kCarrier; }))
    return;
  for (const Measurement& carrier : epoch.measurements) {
    if (carrier.observable != Observable::kCarrier) continue;
    const SatelliteInView& satellite = epoch.satellites[carrier.satellite_index];
    Memory* memory = memory_of(satellite.satellite);
    if (memory == nullptr) continue;  // the table was full
    const RangePrediction range = predict_range(satellite, antenna_p_e);
    memory->time = epoch.time;
    memory->arc = carrier.arc;
    memory->residual_m = carrier.value - range.range_m;
    memory->direction = range.d_range_d_p.transpose();
    memory->variance_m2 = square(carrier.sigma);
    memory->issue = satellite.orbit_issue;
    memory->orbit_sigma_m = satellite.orbit_sigma_m;
    memory->source = satellite.source;
    memory->antenna_issue = satellite.antenna_issue;
    memory->antenna_m = satellite.antenna_m;
  }
  last_time_ = epoch.time;
  last_p_e_ = antenna_p_e;
  memory_.erase(std::remove_if(memory_.begin(), memory_.end(),
                               [&](const Memory& m) {
                                 return seconds_between(epoch.time, m.seen) > kForget_s;
                               }),
                memory_.end());
}

void CarrierFollower::reset() {
  arcs_.reset();
  memory_.clear();
  last_time_ = GpsTime();
}

void CarrierFollower::end_arc(SatelliteId satellite, MeasurementEpoch* epoch) {
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
