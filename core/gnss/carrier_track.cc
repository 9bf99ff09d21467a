#include "core/gnss/carrier_track.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/weighting.h"

namespace leonav {
namespace {

double geometry_free(const CarrierSample& sample) { return sample.carrier(0) - sample.carrier(1); }

GeometryFreeNoise geometry_free_noise(const CycleSlipConfig& config, System system,
                                      const CarrierSample& sample) {
  const bool leo = system == System::kLeo;
  const double factor = elevation_factor(sample.elevation);
  const double ratio = sample.side[0].frequency_hz / sample.side[1].frequency_hz;
  // From a delay on the first frequency to one of the combination.
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
  return std::isfinite(sample.side[0].code_m) && std::isfinite(sample.side[1].code_m);
}

double wide_lane_value(const CarrierSample& sample) {
  // Clock jumps are out of code_m, so they must not come in with the carriers.
  return melbourne_wuebbena_m(
      {sample.carrier(0) - sample.carrier_shift_m, sample.carrier(1) - sample.carrier_shift_m,
       sample.side[0].code_m, sample.side[1].code_m},
      sample.side[0].frequency_hz, sample.side[1].frequency_hz);
}

double code_sigma(const CycleSlipConfig& config, const CarrierSample& sample) {
  return config.code_sigma_m * elevation_factor(sample.elevation);
}

double wide_lane_sigma(const CycleSlipConfig& config, const CarrierSample& sample) {
  return melbourne_wuebbena_sigma_m(code_sigma(config, sample), sample.side[0].frequency_hz,
                                    sample.side[1].frequency_hz);
}

// Receivers count lock time in steps, some of them as coarse as a factor of two (RTCM 10403,
// DF013).
bool lock_was_lost(double before_s, double now_s, double interval_s) {
  constexpr double kStep_s = 0.02;
  if (!std::isfinite(before_s) || !std::isfinite(now_s)) return false;
  if (now_s < before_s - kStep_s) return true;
  const bool has_stopped = now_s == before_s;  // counter at its ceiling
  return !has_stopped && 2.0 * now_s + kStep_s < interval_s;
}

}  // namespace

struct CarrierTrack::PairTest {
  GeometryFreeTrend::Innovation geometry_free;
  MelbourneWuebbena::Deviation wide_lane;
  double code_difference_m = 0.0;  // change of the codes' difference that the carriers' lack
};

bool CarrierTrack::is_same_pair(const CarrierSample& sample) const {
  return known_ && sample.sides == last_.sides && sample.side[0].code == last_.side[0].code &&
         (sample.sides == 1 || sample.side[1].code == last_.side[1].code);
}

bool CarrierTrack::is_continued_by(const CarrierSample& sample, double limit_s) const {
  const double interval_s = seconds_between(sample.time, last_.time);
  return known_ && interval_s > 0.0 && interval_s <= limit_s;
}

CarrierTrack::PairTest CarrierTrack::test_pair(const CycleSlipConfig& config,
                                               const CarrierSample& sample) const {
  PairTest test;
  const double interval_s = seconds_between(sample.time, last_.time);
  const double value = geometry_free(sample);
  test.geometry_free =
      geometry_free_.innovation(value, interval_s, geometry_free_noise(config, system, sample));
  if (!has_codes(sample)) return test;
  test.wide_lane = wide_lane_.deviation(wide_lane_value(sample), wide_lane_sigma(config, sample));
  if (has_codes(last_)) {
    const double codes = sample.side[0].code_m - sample.side[1].code_m;
    const double codes_before = last_.side[0].code_m - last_.side[1].code_m;
    test.code_difference_m = codes - codes_before - (value - geometry_free(last_));
  }
  return test;
}

SlipFindings CarrierTrack::examine(const CycleSlipConfig& config, CarrierSample* sample) const {
  SlipFindings findings;
  const double interval_s = seconds_between(sample->time, last_.time);
  bool resolved = false;
  for (int i = 0; i < sample->sides; ++i) {
    const CarrierSide& before = last_.side[static_cast<std::size_t>(i)];
    CarrierSide& now = sample->side[static_cast<std::size_t>(i)];
    now.repair_m = before.repair_m;
    if (now.loss_of_lock) findings.hard |= SlipCause::kLossOfLock;
    if (config.use_lock_time && lock_was_lost(before.lock_time_s, now.lock_time_s, interval_s)) {
      findings.hard |= SlipCause::kLockTime;
    }
    resolved = resolved || (before.half_cycle_ambiguous && !now.half_cycle_ambiguous);
  }
  if (sample->sides == 1) {
    // Half a cycle is 10 cm: nothing that one frequency offers tells it from none.
    if (resolved) findings.hard |= SlipCause::kHalfCycle;
    return findings;
  }
  PairTest test = test_pair(config, *sample);
  if (resolved) {
    settle_half_cycle(config, test, sample, &findings);
    test = test_pair(config, *sample);
  }
  judge_pair(config, test, *sample, &findings);
  return findings;
}

// Geometry-free and Melbourne-Wuebbena, each alone and both together: what is too small a step for
// either, five cycles against four for one, is not for the two.
void CarrierTrack::judge_pair(const CycleSlipConfig& config, const PairTest& test,
                              const CarrierSample& sample, SlipFindings* findings) const {
  const double gf = std::abs(test.geometry_free.value_m) / test.geometry_free.sigma_m;
  if (config.use_geometry_free && gf > config.geometry_free_limit &&
      std::abs(test.geometry_free.value_m) > config.geometry_free_min_m) {
    findings->hard |= SlipCause::kGeometryFree;
  }
  if (config.use_geometry_free) {
    findings->geometry_free_m =
        std::abs(test.geometry_free.value_m) + 2.0 * test.geometry_free.sigma_m;
  }
  if (test.wide_lane.sigma_m <= 0.0) return;
  // A slip that the geometry-free combination hides moves both carriers alike, so the difference of
  // the codes against theirs stays; a code gone astray moves it.
  constexpr double kCodeOutlier = 5.0;
  findings->code_outlier =
      std::abs(test.code_difference_m) > kCodeOutlier * 2.0 * code_sigma(config, sample) &&
      !findings->hard.has(SlipCause::kGeometryFree);
  if (findings->code_outlier || !config.use_melbourne_wuebbena) return;
  const double cycle = wide_lane_m(sample.side[0].frequency_hz, sample.side[1].frequency_hz);
  const double least = config.melbourne_wuebbena_min_cycles * cycle;
  const MelbourneWuebbena::Deviation& wide = test.wide_lane;
  const double step = std::abs(wide.value_m) / wide.sigma_m;
  const bool by_window =
      wide.window_sigma_m > 0.0 && std::abs(wide.window_m) > least &&
      std::abs(wide.window_m) > config.melbourne_wuebbena_limit * wide.window_sigma_m;
  if ((step > config.melbourne_wuebbena_limit && std::abs(wide.value_m) > least) || by_window) {
    findings->soft |= SlipCause::kMelbourneWuebbena;
  }
  if (config.use_geometry_free && std::abs(wide.value_m) > least &&
      std::hypot(gf, step) > config.joint_limit) {
    findings->soft |= SlipCause::kMelbourneWuebbena;
    findings->soft |= SlipCause::kGeometryFree;
  }
}

// The carrier that was resolved moved by half a cycle or not at all; the trend tells, if it is
// precise enough, and the arc goes on.
void CarrierTrack::settle_half_cycle(const CycleSlipConfig& config, const PairTest& pair,
                                     CarrierSample* sample, SlipFindings* findings) const {
  std::array<double, 2> step{};
  for (std::size_t i = 0; i < 2; ++i) {
    const bool resolved =
        last_.side[i].half_cycle_ambiguous && !sample->side[i].half_cycle_ambiguous;
    step[i] = resolved ? 0.5 * sample->side[i].wavelength_m : 0.0;
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
    findings->hard |= SlipCause::kHalfCycle;
    return;
  }
  for (std::size_t i = 0; i < 2; ++i) sample->side[i].repair_m -= moved[i];
}

void CarrierTrack::start(const CycleSlipConfig& config, const CarrierSample& sample, bool keep) {
  CarrierSample unrepaired(sample);
  for (CarrierSide& side : unrepaired.side) side.repair_m = 0.0;
  begin(config, unrepaired, keep && known_,
        known_ ? seconds_between(sample.time, last_.time) : 0.0);
}

// Repairs stay: what this epoch's carrier was given out with is a constant to the new arc.
void CarrierTrack::restart(const CycleSlipConfig& config) {
  geometry_free_ = geometry_free_before_;
  wide_lane_ = wide_lane_before_;
  begin(config, CarrierSample(last_), true, last_interval_s_);
}

void CarrierTrack::begin(const CycleSlipConfig& config, const CarrierSample& sample, bool keep,
                         double interval_s) {
  geometry_free_before_ = geometry_free_;
  wide_lane_before_ = wide_lane_;
  last_interval_s_ = interval_s;
  last_ = sample;
  known_ = true;
  if (sample.sides == 1) return;
  geometry_free_.start(geometry_free(last_), interval_s, geometry_free_noise(config, system, last_),
                       keep);
  wide_lane_.clear(keep);
  learn_codes(config);
}

void CarrierTrack::update(const CycleSlipConfig& config, const CarrierSample& sample,
                          bool with_codes) {
  geometry_free_before_ = geometry_free_;
  wide_lane_before_ = wide_lane_;
  last_interval_s_ = seconds_between(sample.time, last_.time);
  last_ = sample;
  if (sample.sides == 1) return;
  geometry_free_.update(geometry_free(sample), last_interval_s_,
                        geometry_free_noise(config, system, sample));
  if (with_codes) learn_codes(config);
}

void CarrierTrack::learn_codes(const CycleSlipConfig& config) {
  if (last_.sides == 1 || !has_codes(last_)) return;
  wide_lane_.update(wide_lane_value(last_), wide_lane_sigma(config, last_));
}

}  // namespace leonav
