// Runs the cycle slip detectors over epochs of which some carriers have been made to slip, and
// counts what they find.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/gnss/cycle_slips/carrier_arcs.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/measurement/weighting.h"
#include "core/gnss/signals/band_plan.h"
#include "support/slips/slip_counts.h"
#include "support/slips/slip_prediction.h"

namespace leonav::test {

inline constexpr double kSlipMask = 0.2617993877991494;  // 15 degrees

struct SlipScene {
  std::vector<RawEpoch> epochs;
  // Of a satellite with this pseudorange at epoch k; nullopt: no orbit.
  std::function<std::optional<Prediction>(std::size_t k, SatelliteId, double pseudorange_m)>
      predict;
  RangeChangePrior prior;
  bool use_range_change = true;
  bool second_signals = true;
  double clock_walk_m = 0.0;            // satellite clocks, per sqrt(s)
  double carrier_sigma_m = 0.002;       // of one signal
  double ionosphere_rate_m_s = 0.0005;  // 1 sigma, of a single frequency's range change
};

class SlipRun {
 public:
  SlipRun(const SlipScene& scene, const CycleSlipConfig& config)
      : scene_(scene), config_(config), arcs_(config) {}

  SlipCounts run(const std::vector<Injection>& injections = {}) {
    for (const Injection& slip : injections) {
      by_place_[{slip.epoch, slip.satellite}] = slip;
      slip_epochs_.insert(slip.epoch);
    }
    counts_.injected = static_cast<long>(injections.size());
    for (std::size_t k = 0; k < scene_.epochs.size(); ++k) step(k);
    for (const auto& [place, slip] : open_) {
      (void)place;
      ++counts_.missed;
      counts_.notes.push_back("missed " + to_string(slip.satellite) + " " +
                              std::to_string(slip.first) + "/" + std::to_string(slip.second) +
                              " epoch " + std::to_string(slip.epoch));
    }
    return counts_;
  }

  // Satellite-epochs whose arc goes on from the epoch before, above the mask: of a run without
  // slips.
  struct Going {
    std::size_t epoch;
    SatelliteId satellite;
    bool pair;
  };
  const std::vector<Going>& going() const { return going_; }

 private:
  struct Before {
    std::size_t epoch = 0;
    double value_m = 0.0, range_m = 0.0;
    Eigen::Vector3d direction;
    std::uint32_t arc = 0;
    std::uint32_t issue = 0;
    std::optional<Ephemeris> elements;
  };

  void step(std::size_t k) {
    RawEpoch raw = scene_.epochs[k];
    slip_carriers(k, &raw);
    std::vector<CarrierInput> inputs;
    std::vector<std::optional<Prediction>> predictions;
    collect(k, raw, &inputs, &predictions);
    ArcEpoch epoch;
    arcs_.process(raw.time, inputs, &epoch);
    if (epoch.clock_jump.any()) ++counts_.clock_jumps;
    std::vector<RangeChangeRowResult> verdicts(inputs.size());
    if (scene_.use_range_change) check_geometry(k, raw, inputs, predictions, epoch, &verdicts);
    arcs_.apply_range_change(verdicts, &epoch);
    remember(k, inputs, predictions, epoch);
    for (std::size_t i = 0; i < inputs.size(); ++i) count(k, inputs[i], epoch.satellites[i]);
  }

  void slip_carriers(std::size_t k, RawEpoch* raw) {
    for (SignalObservation& o : raw->observations) {
      const auto found = by_place_.find({k, o.satellite});
      if (found != by_place_.end() && touched_.insert({k, o.satellite}).second) {
        offsets_[o.satellite][0] += found->second.first;
        offsets_[o.satellite][1] += found->second.second;
      }
      const auto offset = offsets_.find(o.satellite);
      if (offset == offsets_.end()) continue;
      const char first_band = o.satellite.system == System::kBeidou ? '2' : '1';
      o.carrier_cycles += offset->second[o.code.band == first_band ? 0 : 1];
      if (found != by_place_.end() && found->second.flagged) o.loss_of_lock = true;
    }
  }

  // Of each satellite the first signal with code and carrier on the first band, and on a second.
  void collect(std::size_t k, const RawEpoch& raw, std::vector<CarrierInput>* inputs,
               std::vector<std::optional<Prediction>>* predictions) {
    const GnssConfig gnss = default_gnss_config();
    std::map<SatelliteId, std::map<char, const SignalObservation*>> bands;
    for (const SignalObservation& o : raw.observations) {
      if (!std::isfinite(o.carrier_cycles) || !std::isfinite(o.pseudorange_m)) continue;
      bands[o.satellite].insert({o.code.band, &o});
    }
    for (const auto& [satellite, signals] : bands) {
      const SignalPreference& preference = gnss.systems[index_of(satellite.system)].signals;
      CarrierInput input;
      const auto first = signals.find(preference.first_band);
      if (first == signals.end()) continue;
      input.first = first->second;
      for (const char band : preference.second_bands) {
        const auto second = signals.find(band);
        if (second != signals.end() && input.second == nullptr) input.second = second->second;
      }
      if (!scene_.second_signals) input.second = nullptr;
      // A pair that lacks its second signal for an epoch is left out of it.
      if (input.second == nullptr && scene_.second_signals && pairs_.count(satellite) > 0) continue;
      if (input.second != nullptr) pairs_.insert(satellite);
      const auto prediction = scene_.predict(k, satellite, input.first->pseudorange_m);
      input.elevation = prediction ? prediction->elevation : 0.0;
      inputs->push_back(input);
      predictions->push_back(prediction);
    }
  }

  static double combined(const CarrierInput& input, const CarrierStatus& status,
                         IonosphereFree* factors) {
    const System system = input.first->satellite.system;
    *factors = {1.0, 0.0};
    if (!std::isfinite(status.second_m)) return status.first_m;
    *factors = ionosphere_free(BandPlan().frequency_hz(system, input.first->code.band),
                               BandPlan().frequency_hz(system, input.second->code.band));
    return factors->gamma1 * status.first_m + factors->gamma2 * status.second_m;
  }

  // What other elements add to the carrier against its range, as the program takes it out.
  static double elements_step_m(const Before& before, const Prediction& now) {
    if (before.issue == now.issue) return 0.0;
    return orbit_step_m(*before.elements, *now.elements, now.sent, now.antenna_p_e);
  }
  static bool is_comparable(const Before& before, const Prediction& now) {
    return before.issue == now.issue || (before.elements && now.elements);
  }

  double row_sigma_m(double elevation, bool pair, const IonosphereFree& factors,
                     double interval_s) const {
    const double weight = elevation_factor(elevation);
    const double noise = std::sqrt(2.0) * scene_.carrier_sigma_m * weight *
                         std::hypot(factors.gamma1, factors.gamma2);
    const double ionosphere = pair ? 0.0 : scene_.ionosphere_rate_m_s * weight * interval_s;
    return std::sqrt(noise * noise + ionosphere * ionosphere +
                     scene_.clock_walk_m * scene_.clock_walk_m * interval_s);
  }

  // Whether a cycle of this one carrier is beyond the limit of a row that all others check.
  bool shows_a_cycle(std::size_t k, const CarrierInput& input) const {
    if (!scene_.use_range_change || k == 0) return false;
    const double interval_s = seconds_between(scene_.epochs[k].time, scene_.epochs[k - 1].time);
    const double sigma_m = row_sigma_m(input.elevation, false, {1.0, 0.0}, interval_s);
    const SignalObservation& first = *input.first;
    return config_.range_change_limit * sigma_m <=
           BandPlan().wavelength_m(first.satellite.system, first.code.band);
  }

  void check_geometry(std::size_t k, const RawEpoch& raw, const std::vector<CarrierInput>& inputs,
                      const std::vector<std::optional<Prediction>>& predictions,
                      const ArcEpoch& epoch, std::vector<RangeChangeRowResult>* verdicts) {
    if (k == 0) return;
    const double interval_s = seconds_between(raw.time, scene_.epochs[k - 1].time);
    std::vector<RangeChangeRow> rows;
    std::vector<std::size_t> owners;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const CarrierStatus& status = epoch.satellites[i];
      const auto before = before_.find(inputs[i].first->satellite);
      if (status.arc == 0 || status.started || !predictions[i] || before == before_.end() ||
          before->second.epoch + 1 != k || before->second.arc != status.arc ||
          !is_comparable(before->second, *predictions[i])) {
        continue;
      }
      const Prediction& now = *predictions[i];
      IonosphereFree factors;
      RangeChangeRow row;
      row.residual_m = combined(inputs[i], status, &factors) - before->second.value_m -
                       (now.range_m - before->second.range_m) -
                       elements_step_m(before->second, now);
      row.direction = now.direction;
      row.direction_change = now.direction - before->second.direction;
      row.sigma_m = row_sigma_m(now.elevation, std::isfinite(status.second_m), factors, interval_s);
      row.system_time = static_cast<int>(index_of(inputs[i].first->satellite.system));
      rows.push_back(row);
      owners.push_back(i);
    }
    const RangeChangeResult result = range_change(rows, scene_.prior, config_);
    if (result.status == RangeChangeStatus::kUndecidable) ++counts_.undecidable;
    for (std::size_t i = 0; i < owners.size(); ++i) (*verdicts)[owners[i]] = result.rows[i];
  }

  void remember(std::size_t k, const std::vector<CarrierInput>& inputs,
                const std::vector<std::optional<Prediction>>& predictions, const ArcEpoch& epoch) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (!predictions[i] || epoch.satellites[i].arc == 0) continue;
      IonosphereFree factors;
      before_[inputs[i].first->satellite] = {k,
                                             combined(inputs[i], epoch.satellites[i], &factors),
                                             predictions[i]->range_m,
                                             predictions[i]->direction,
                                             epoch.satellites[i].arc,
                                             predictions[i]->issue,
                                             predictions[i]->elements};
    }
  }

  static constexpr std::size_t kLate = 2;  // epochs

  void count(std::size_t k, const CarrierInput& input, const CarrierStatus& status) {
    const SatelliteId id = input.first->satellite;
    const bool pair = std::isfinite(status.second_m);
    if (status.started) {
      ++counts_.arcs;
      if (!status.causes.any()) ++counts_.first_arcs;
      for (const SlipCause cause : kSlipCauses) counts_.ends[cause] += status.causes.has(cause);
    }
    const auto slip = by_place_.find({k, id});
    if (input.elevation >= kSlipMask) {
      ++counts_.satellite_epochs;
      if (!status.started) going_.push_back({k, id, pair});
    }
    if (slip != by_place_.end()) {
      auto& kind = counts_.by_kind[kind_of(slip->second, pair)];
      ++kind.second;
      kind.first += status.started;
      if (!status.started) {
        open_[id] = slip->second;
        return;
      }
      ++counts_.at_once;
      for (const SlipCause cause : kSlipCauses) counts_.share[cause] += status.causes.has(cause);
      open_.erase(id);
      return;
    }
    const auto open = open_.find(id);
    const bool by_receiver =
        status.causes.has(SlipCause::kGap) || status.causes.has(SlipCause::kSignalChanged) ||
        status.causes.has(SlipCause::kLossOfLock) || status.causes.has(SlipCause::kLockTime);
    if (open != open_.end()) {
      const bool in_time = k <= open->second.epoch + kLate;
      if (status.started && in_time) ++counts_.late;
      if (status.started && !in_time) {
        ++counts_.missed;
        counts_.notes.push_back("missed " + to_string(id) + " " +
                                std::to_string(open->second.first) + "/" +
                                std::to_string(open->second.second));
      }
      if (status.started) open_.erase(open);
      return;
    }
    if (!status.started || by_receiver || !status.causes.any()) return;
    if (input.elevation < kSlipMask) return;
    if (status.causes == SlipCauses(SlipCause::kUntested) && !shows_a_cycle(k, input)) {
      ++counts_.too_weak;
      return;
    }
    ++counts_.false_alarms;
    counts_.false_at_slips += static_cast<long>(slip_epochs_.count(k));
    std::string what = "false " + to_string(id) + " epoch " + std::to_string(k) + " elevation " +
                       std::to_string(static_cast<int>(input.elevation * 57.3)) + ":";
    for (const SlipCause cause : kSlipCauses) {
      counts_.false_share[cause] += status.causes.has(cause);
      if (status.causes.has(cause)) what += " " + std::string(to_string(cause));
    }
    counts_.notes.push_back(what);
  }

  const SlipScene& scene_;
  CycleSlipConfig config_;
  CarrierArcs arcs_;
  SlipCounts counts_;
  std::map<std::pair<std::size_t, SatelliteId>, Injection> by_place_;
  std::set<std::size_t> slip_epochs_;
  std::set<std::pair<std::size_t, SatelliteId>> touched_;
  std::map<SatelliteId, std::array<double, 2>> offsets_;
  std::map<SatelliteId, Before> before_;
  std::map<SatelliteId, Injection> open_;
  std::set<SatelliteId> pairs_;
  std::vector<Going> going_;
};

}  // namespace leonav::test
