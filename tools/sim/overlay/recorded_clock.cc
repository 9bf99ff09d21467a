#include "tools/sim/overlay/recorded_clock.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/gnss/measurement/range_model.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/signals/signal.h"
#include "tools/quality/input_log.h"

namespace leonav::sim {
namespace {

constexpr std::size_t kLeastSatellites = 3;
// If the median distance of codes from their median is larger, they belong to another position than
// the truth's.
constexpr double kWidestScatter_m = 300.0;

double median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

double scatter_about(double middle, const std::vector<double>& values) {
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - middle));
  return median(&distances);
}

GnssConfig every_code() {
  GnssConfig config = default_gnss_config();
  config.code_combination = CodeCombination::kSingleFrequency;
  return config;
}

// The codes of one band of one system: all others have another delay in the receiver.
using Group = std::pair<System, char>;

// The clock at one epoch.
struct Sighting {
  GpsTime stamp;
  std::map<Group, double> code_m;        // medians of the groups with enough satellites
  double drift_m_s = 0.0;                // median of all Dopplers
  std::optional<double> carrier_step_m;  // of the carriers' clock, since the previous epoch
};

class Reading {
 public:
  Reading(const Scenario& scenario, const SplineMotion& motion)
      : lever_arm_b_(scenario.receiver.lever_arm_b), motion_(motion), config_(every_code()) {}

  EphemerisStore* ephemeris_store() { return &ephemeris_store_; }

  void take(const RawEpoch& raw) {
    const double tag = seconds_between(raw.time, motion_.start());
    Sighting now;
    double t = tag;
    // The second round uses the antenna's position at the true time of reception.
    for (int round = 0; round < 2; ++round) {
      if (t < 0.0 || t > motion_.duration_s()) return;
      now = Sighting();
      now.stamp = raw.time;
      if (!measure(raw, t, &now)) {
        ++without_;
        return;
      }
      t = tag - now.code_m.begin()->second / kSpeedOfLight;
    }
    follow_carriers(&now);
    sightings_.push_back(std::move(now));
  }

  RecordedClock clock() const;

 private:
  bool measure(const RawEpoch& raw, double t, Sighting* sighting);
  void follow_carriers(Sighting* now);

  Eigen::Vector3d lever_arm_b_;
  const SplineMotion& motion_;
  GnssConfig config_;
  EphemerisStore ephemeris_store_{config_.ephemeris_store};
  std::unique_ptr<MeasurementEpoch> epoch_ = std::make_unique<MeasurementEpoch>();
  // Carriers minus ranges, m, of this epoch and of the previous one.
  std::map<std::pair<SatelliteId, SignalCode>, double> carriers_, carriers_before_;
  std::vector<Sighting> sightings_;
  long without_ = 0;
};

bool Reading::measure(const RawEpoch& raw, double t, Sighting* sighting) {
  const MotionInstant now = motion_.at(t);
  const Eigen::Vector3d p_a_e = now.p_e + now.q_eb.toRotationMatrix() * lever_arm_b_;
  preprocess(raw, ephemeris_store_, config_, p_a_e, epoch_.get());
  std::map<Group, std::vector<double>> codes;
  std::vector<double> dopplers;
  carriers_.clear();
  for (const Measurement& m : epoch_->measurements) {
    const SatelliteInView& satellite = epoch_->satellites[m.satellite_index];
    if (satellite.reason != Reason::kUsed || m.reason != Reason::kUsed) continue;
    if (m.observable == Observable::kDoppler) {
      // Rates are per second of the receiver's clock: m = (rate + c drift) / (1 + drift).
      const double rate = predict_range_rate(satellite, p_a_e, now.v_e).range_rate_m_s;
      dopplers.push_back((m.value - rate) / (1.0 - m.value / kSpeedOfLight));
    }
    if (m.observable != Observable::kCode) continue;
    const double range = predict_range(satellite, p_a_e).range_m;
    codes[{satellite.satellite.system, m.code.band}].push_back(m.value - range);
    const auto raw_one = std::ranges::find_if(raw.observations, [&](const auto& o) {
      return o.satellite == satellite.satellite && o.code == m.code;
    });
    // The sign of the ionospheric delay does not matter within a second.
    if (raw_one != raw.observations.end() && !raw_one->loss_of_lock) {
      carriers_[{satellite.satellite, m.code}] =
          raw_one->carrier_cycles * wavelength_m(satellite.satellite.system, m.code.band) +
          m.value - raw_one->pseudorange_m - range;
    }
  }
  for (auto& [group, values] : codes) {
    if (values.size() < kLeastSatellites) continue;
    const double middle = median(&values);
    if (scatter_about(middle, values) < kWidestScatter_m) sighting->code_m[group] = middle;
  }
  if (sighting->code_m.empty() || dopplers.size() < kLeastSatellites) return false;
  sighting->drift_m_s = median(&dopplers);
  return true;
}

void Reading::follow_carriers(Sighting* now) {
  std::vector<double> steps;
  for (const auto& [signal, value] : carriers_) {
    const auto before = carriers_before_.find(signal);
    if (before == carriers_before_.end()) continue;
    const double step = value - before->second;
    if (std::isfinite(step)) steps.push_back(step);
  }
  if (steps.size() >= kLeastSatellites) now->carrier_step_m = median(&steps);
  carriers_before_ = carriers_;
}

RecordedClock Reading::clock() const {
  RecordedClock clock;
  clock.without = without_;
  std::map<Group, long> epochs;
  for (const Sighting& s : sightings_) {
    for (const auto& [group, value] : s.code_m) ++epochs[group];
  }
  if (epochs.empty()) return clock;
  const Group reference =
      std::ranges::max_element(epochs, {}, [](const auto& e) { return e.second; })->first;
  std::map<Group, std::vector<double>> beyond;  // relative to the reference group
  for (const Sighting& s : sightings_) {
    if (!s.code_m.contains(reference)) continue;
    for (const auto& [group, value] : s.code_m)
      beyond[group].push_back(value - s.code_m.at(reference));
  }
  const Sighting* before = nullptr;
  double carrier_m = 0.0;
  for (const Sighting& s : sightings_) {
    const auto found = s.code_m.contains(reference) ? s.code_m.find(reference) : s.code_m.begin();
    auto& offsets = beyond[found->first];
    if (offsets.empty()) {
      ++clock.without;
      continue;
    }
    const double code_m = found->second - median(&offsets);
    const double dt = before != nullptr ? seconds_between(s.stamp, before->stamp) : 0.0;
    if (before == nullptr) {
      carrier_m = code_m;
    } else if (s.carrier_step_m) {
      carrier_m += *s.carrier_step_m;
    } else {
      carrier_m += 0.5 * (s.drift_m_s + before->drift_m_s) * dt;
    }
    ClockReading& reading = clock.readings[s.stamp];
    reading.code_s = code_m / kSpeedOfLight;
    reading.carrier_s = carrier_m / kSpeedOfLight;
    reading.drift = s.drift_m_s / kSpeedOfLight;
    reading.t = seconds_between(s.stamp, motion_.start()) - reading.code_s;
    before = &s;
  }
  return clock;
}

}  // namespace

RecordedClock recorded_clock(const std::string& log, const Scenario& scenario,
                             const SplineMotion& motion) {
  Reading reading(scenario, motion);
  const InputHandlers handlers{[&reading](const RawEpoch& raw) { reading.take(raw); },
                               reading.ephemeris_store()};
  const InputCounts counts =
      read_inputs(log, std::string(kDefaultChannelPrefix), handlers, nullptr);
  RecordedClock clock = reading.clock();
  clock.other_prefix = counts.other_prefix;
  return clock;
}

}  // namespace leonav::sim
