#include "core/gnss/cycle_slips/internal/arc_detectors.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

double geometry_free(const CarrierSample& sample) { return sample.carrier(0) - sample.carrier(1); }

GeometryFreeNoise noise_of(const CycleSlipConfig& config, System system,
                           const CarrierSample& sample) {
  const bool leo = system == System::kLeo;
  const double factor = elevation_factor(sample.elevation);
  const double ratio = sample.signal[0].frequency_hz / sample.signal[1].frequency_hz;
  // Factor from a delay on the first frequency to one of the combination.
  const double of_ionosphere = std::abs(ratio * ratio - 1.0);
  GeometryFreeNoise noise;
  noise.value_m = config.carrier_sigma_m * std::sqrt(2.0) * factor;
  noise.rate_m_s =
      of_ionosphere * factor * (leo ? config.ionosphere_rate_leo_m_s : config.ionosphere_rate_m_s);
  noise.rate_walk_m_s =
      of_ionosphere * factor *
      (leo ? config.ionosphere_rate_walk_leo_m_s : config.ionosphere_rate_walk_m_s);
  return noise;
}

bool has_codes(const CarrierSample& sample) {
  return std::isfinite(sample.signal[0].code_m) && std::isfinite(sample.signal[1].code_m);
}

double wide_lane_value(const CarrierSample& sample) {
  // Clock jumps are removed from code_m, so they must be removed from the carriers too.
  return melbourne_wuebbena_m(
      {sample.carrier(0) - sample.carrier_shift_m, sample.carrier(1) - sample.carrier_shift_m,
       sample.signal[0].code_m, sample.signal[1].code_m},
      sample.signal[0].frequency_hz, sample.signal[1].frequency_hz);
}

double code_sigma(const CycleSlipConfig& config, const CarrierSample& sample) {
  return config.code_sigma_m * elevation_factor(sample.elevation);
}

double wide_lane_sigma(const CycleSlipConfig& config, const CarrierSample& sample) {
  return melbourne_wuebbena_sigma_m(code_sigma(config, sample), sample.signal[0].frequency_hz,
                                    sample.signal[1].frequency_hz);
}

// Returns whether the lock was lost. Receivers count lock time in steps, some as coarse as a factor
// of two (RTCM 10403, DF013).
bool lock_was_lost(double before_s, double now_s, double interval_s) {
  constexpr double kStep_s = 0.02;
  if (!std::isfinite(before_s) || !std::isfinite(now_s)) return false;
  if (now_s < before_s - kStep_s) return true;
  const bool has_stopped = now_s == before_s;  // counter at its maximum
  return !has_stopped && 2.0 * now_s + kStep_s < interval_s;
}

}  // namespace

struct ArcDetectors::PairTest {
  GeometryFreeTrend::Innovation geometry_free;
  MelbourneWuebbena::Deviation wide_lane;
  double code_difference_m = 0.0;  // change of the codes' difference beyond that of the carriers'
};

bool ArcDetectors::is_same_pair(const CarrierSample& sample) const {
  return known_ && sample.signal_count == last_.signal_count &&
         sample.signal[0].code == last_.signal[0].code &&
         (sample.signal_count == 1 || sample.signal[1].code == last_.signal[1].code);
}

bool ArcDetectors::is_continued_by(const CarrierSample& sample, double limit_s) const {
  const double interval_s = seconds_between(sample.time, last_.time);
  return known_ && interval_s > 0.0 && interval_s <= limit_s;
}

ArcDetectors::PairTest ArcDetectors::test_pair(const CycleSlipConfig& config,
                                               const CarrierSample& sample) const {
  PairTest test;
  const double interval_s = seconds_between(sample.time, last_.time);
  const double value = geometry_free(sample);
  test.geometry_free =
      geometry_free_.innovation(value, interval_s, noise_of(config, system, sample));
  if (!has_codes(sample)) return test;
  test.wide_lane = wide_lane_.deviation(wide_lane_value(sample), wide_lane_sigma(config, sample));
  if (has_codes(last_)) {
    const double codes = sample.signal[0].code_m - sample.signal[1].code_m;
    const double codes_before = last_.signal[0].code_m - last_.signal[1].code_m;
    test.code_difference_m = codes - codes_before - (value - geometry_free(last_));
  }
  return test;
}

GeometryFreeNoise ArcDetectors::geometry_free_noise(const CycleSlipConfig& config) const {
  return noise_of(config, system, last_);
}

SlipFindings ArcDetectors::detect_slips(const CycleSlipConfig& config,
                                        CarrierSample* sample) const {
  SlipFindings findings;
  const double interval_s = seconds_between(sample->time, last_.time);
  bool resolved = false;
  for (int i = 0; i < sample->signal_count; ++i) {
    const CarrierSignal& before = last_.signal[static_cast<std::size_t>(i)];
    CarrierSignal& now = sample->signal[static_cast<std::size_t>(i)];
    now.repair_m = before.repair_m;
    if (now.loss_of_lock) findings.certain |= SlipCause::kLossOfLock;
    if (config.use_lock_time && lock_was_lost(before.lock_time_s, now.lock_time_s, interval_s)) {
      findings.certain |= SlipCause::kLockTime;
    }
    resolved = resolved || (before.half_cycle_ambiguous && !now.half_cycle_ambiguous);
  }
  if (sample->signal_count == 1) {
    // Half a cycle is 10 cm: a single frequency cannot distinguish it from none.
    if (resolved) findings.certain |= SlipCause::kHalfCycle;
    return findings;
  }
  PairTest test = test_pair(config, *sample);
  if (resolved) {
    resolve_half_cycle(config, test, sample, &findings);
    test = test_pair(config, *sample);
  }
  evaluate_pair(config, test, *sample, &findings);
  return findings;
}

// Tests geometry-free and Melbourne-Wuebbena, each alone and both together: a step that is too
// small for either one, as five cycles against four, is not too small for both.
void ArcDetectors::evaluate_pair(const CycleSlipConfig& config, const PairTest& test,
                                 const CarrierSample& sample, SlipFindings* findings) const {
  const double gf = std::abs(test.geometry_free.value_m) / test.geometry_free.sigma_m;
  if (config.use_geometry_free && gf > config.geometry_free_limit &&
      std::abs(test.geometry_free.value_m) > config.geometry_free_min_m) {
    findings->certain |= SlipCause::kGeometryFree;
  }
  if (config.use_geometry_free) {
    findings->geometry_free_m =
        std::abs(test.geometry_free.value_m) + 2.0 * test.geometry_free.sigma_m;
  }
  if (test.wide_lane.sigma_m <= 0.0) return;
  // A slip that the geometry-free combination hides moves both carriers equally, so the difference
  // of the codes against theirs is unchanged; a code outlier changes it.
  constexpr double kCodeOutlier = 5.0;
  findings->code_outlier =
      std::abs(test.code_difference_m) > kCodeOutlier * 2.0 * code_sigma(config, sample) &&
      !findings->certain.has(SlipCause::kGeometryFree);
  if (findings->code_outlier || !config.use_melbourne_wuebbena) return;
  const double cycle = wide_lane_m(sample.signal[0].frequency_hz, sample.signal[1].frequency_hz);
  const double least = config.melbourne_wuebbena_min_cycles * cycle;
  const MelbourneWuebbena::Deviation& wide = test.wide_lane;
  const double step = std::abs(wide.value_m) / wide.sigma_m;
  const bool by_window =
      wide.window_sigma_m > 0.0 && std::abs(wide.window_m) > least &&
      std::abs(wide.window_m) > config.melbourne_wuebbena_limit * wide.window_sigma_m;
  if ((step > config.melbourne_wuebbena_limit && std::abs(wide.value_m) > least) || by_window) {
    findings->refutable |= SlipCause::kMelbourneWuebbena;
  }
  if (config.use_geometry_free && std::abs(wide.value_m) > least &&
      std::hypot(gf, step) > config.joint_limit) {
    findings->refutable |= SlipCause::kMelbourneWuebbena;
    findings->refutable |= SlipCause::kGeometryFree;
  }
}

// The carrier that was resolved moved by half a cycle or not at all. Where the trend is precise
// enough it decides between the two, and the arc goes on.
void ArcDetectors::resolve_half_cycle(const CycleSlipConfig& config, const PairTest& pair,
                                      CarrierSample* sample, SlipFindings* findings) const {
  std::array<double, 2> step{};
  for (std::size_t i = 0; i < 2; ++i) {
    const bool resolved =
        last_.signal[i].half_cycle_ambiguous && !sample->signal[i].half_cycle_ambiguous;
    step[i] = resolved ? 0.5 * sample->signal[i].wavelength_m : 0.0;
  }
  double best = HUGE_VAL, second = HUGE_VAL;
  std::array<double, 2> moved{};
  for (int a = -1; a <= 1; ++a) {
    for (int b = -1; b <= 1; ++b) {
      if ((a != 0 && step[0] == 0.0) || (b != 0 && step[1] == 0.0)) continue;
      const double left = std::abs(pair.geometry_free.value_m - a * step[0] + b * step[1]);
      if (left < best) {
        second = best;
        best = left;
        moved = {a * step[0], b * step[1]};
      } else {
        second = std::min(second, left);
      }
    }
  }
  const double limit = config.geometry_free_limit * pair.geometry_free.sigma_m;
  if (best > limit || second < limit) {
    findings->certain |= SlipCause::kHalfCycle;
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) sample->signal[i].repair_m -= moved[i];
}

void ArcDetectors::start(const CycleSlipConfig& config, const CarrierSample& sample, bool keep) {
  CarrierSample unrepaired(sample);
  for (CarrierSignal& signal : unrepaired.signal) signal.repair_m = 0.0;
  begin(config, unrepaired, keep && known_,
        known_ ? seconds_between(sample.time, last_.time) : 0.0);
}

// Repairs are kept: what this epoch's carrier already contains is a constant of the new arc.
void ArcDetectors::restart(const CycleSlipConfig& config) {
  geometry_free_ = geometry_free_before_;
  wide_lane_ = wide_lane_before_;
  begin(config, CarrierSample(last_), true, last_interval_s_);
}

void ArcDetectors::begin(const CycleSlipConfig& config, const CarrierSample& sample, bool keep,
                         double interval_s) {
  geometry_free_before_ = geometry_free_;
  wide_lane_before_ = wide_lane_;
  last_interval_s_ = interval_s;
  last_ = sample;
  known_ = true;
  if (sample.signal_count == 1) return;
  geometry_free_.start(geometry_free(last_), interval_s, noise_of(config, system, last_), keep);
  wide_lane_.clear(keep);
  update_wide_lane(config);
}

void ArcDetectors::update(const CycleSlipConfig& config, const CarrierSample& sample,
                          bool with_codes) {
  geometry_free_before_ = geometry_free_;
  wide_lane_before_ = wide_lane_;
  last_interval_s_ = seconds_between(sample.time, last_.time);
  last_ = sample;
  if (sample.signal_count == 1) return;
  geometry_free_.update(geometry_free(sample), last_interval_s_, noise_of(config, system, sample));
  if (with_codes) update_wide_lane(config);
}

void ArcDetectors::update_wide_lane(const CycleSlipConfig& config) {
  if (last_.signal_count == 1 || !has_codes(last_)) return;
  wide_lane_.update(wide_lane_value(last_), wide_lane_sigma(config, last_));
}

}  // namespace leonav
