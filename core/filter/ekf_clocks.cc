// The clocks of Ekf: their start, and the steps that their noise does not hold.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/median.h"
#include "core/base/square.h"
#include "core/filter/ekf.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "core/filter/innovation_tests/prediction_consistency.h"
#include "core/filter/state/ambiguities.h"
#include "core/filter/state/clock_model.h"

namespace leonav {
namespace {

using namespace ekf_index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kStartClockSigma = 100.0;  // m, a new base's offset: so wide that the measurements
                                            // it was started from are hardly counted twice
constexpr double kStartDriftSigma = 10.0;   // m/s, likewise
constexpr double kUnknownDrift = 300.0;     // m/s, an oscillator off by 1 ppm
constexpr double kInterSystemDriftSigma = 1.0;  // m/s, between the drifts of two bases
constexpr double kMaxJumpSigma = 100.0;         // m, widening of the clocks after a jump
constexpr double kMadToSigma = 1.4826;
constexpr double kMillisecond_m = 299'792.458;
constexpr double kExactSigmas = 5.0;      // nearer to whole milliseconds, a step is taken as these
constexpr double kRoughStepSigma = 10.0;  // m, of a step that fewer than four satellites tell
// Codes of one system in a street have been seen 5.5 sigma apart from the others' for an epoch.
constexpr double kCertainSigmas = 15.0;
constexpr double kSameStepShare = 0.5;  // steps of two epochs, apart by less of them, are one
// So long that a passing reflection at 1 Hz is over.
constexpr int kMaxEpochsWithoutAcceptedCode = 10;
constexpr int kClockRestarts = -1;      // instead of a count
constexpr int kMinOthers = 4;           // codes that stand against a base
constexpr double kVagueSigma_m = 20.0;  // of a prediction that does not see a base's step

struct Start {
  double value = 0.0;
  double sigma = 0.0;
};

// Where a clock state should start so that most innovations of its base vanish.
std::optional<Start> start_from(const FilterMeasurements& measurements,
                                const MeasurementEpoch& epoch, Observable observable,
                                std::size_t base) {
  SmallTable innovations;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable == observable &&
        base_of(measurement, epoch) == static_cast<int>(base))
      innovations.push_back(measurement.innovation);
  }
  if (innovations.empty()) return std::nullopt;
  Start start;
  start.value = median(innovations);
  SmallTable deviations;
  for (const double innovation : innovations)
    deviations.push_back(std::abs(innovation - start.value));
  start.sigma = 3.0 * kMadToSigma * median(deviations);
  return start;
}

bool is_base(int base, int wanted) { return wanted == kAllBases || base == wanted; }

// The step may be off by as much as it is large, up to what no noise of codes reaches: found in the
// measurements that the update is to use, its value is theirs to find.
double step_sigma(const CommonStep& step) {
  return std::max(std::min(std::abs(step.value_m), kMaxJumpSigma), step.sigma_m);
}

}  // namespace

void Ekf::start_offset(std::size_t base, double offset_m, double sigma_m) {
  start_clock_offset(base, offset_m, sigma_m, &state_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClock + static_cast<Eigen::Index>(base), square(sigma_m));
}

void Ekf::start_drift(std::size_t base, double drift_m_s, double sigma_m_s) {
  start_clock_drift(base, drift_m_s, sigma_m_s, &state_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClockDrift + static_cast<Eigen::Index>(base), square(sigma_m_s));
}

void Ekf::copy_drift(std::size_t from, std::size_t to, double sigma_m_s) {
  copy_clock_drift(from, to, sigma_m_s, &state_.clocks, &covariance_);
  if (!process_.continuous) return;
  const auto f = kClockDrift + static_cast<Eigen::Index>(from);
  const auto t = kClockDrift + static_cast<Eigen::Index>(to);
  EkfCovariance& N = process_.noise;
  N.row(t) = N.row(f);
  N.col(t) = N.col(f);
  N(t, t) = N(f, f) + square(sigma_m_s);
  process_.transition.row(t) = process_.transition.row(f);
}

// Starts the clocks of bases that appear for the first time; true if any: the innovations change.
bool Ekf::start_clocks(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  bool started = false;
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (known_clocks_.offset[base]) continue;
    const auto code = start_from(measurements_, epoch, Observable::kCode, base);
    const auto doppler = start_from(measurements_, epoch, Observable::kDoppler, base);
    if (!code && !doppler) continue;
    if (!known_clocks_.drift[base]) {
      std::size_t other = 0;
      while (other < kMaxTimeBases && !known_clocks_.drift[other]) ++other;
      if (other < kMaxTimeBases)
        copy_drift(other, base, kInterSystemDriftSigma);
      else if (doppler)
        start_drift(base, state_.clocks.drift_m_s(static_cast<Eigen::Index>(base)) + doppler->value,
                    kStartDriftSigma + doppler->sigma);
      else
        start_drift(base, 0.0, kUnknownDrift);
      known_clocks_.drift[base] = true;
      started = true;
    }
    if (code) {
      start_offset(base, state_.clocks.offset_m(static_cast<Eigen::Index>(base)) + code->value,
                   kStartClockSigma + code->sigma);
      known_clocks_.offset[base] = true;
      if (epochs_without_accepted_code_[base] == kClockRestarts)
        result->inter_system_step_m[base] = code->value;
      epochs_without_accepted_code_[base] = 0;
      started = true;
    }
  }
  return started;
}

// Codes that step against their carriers: the clock takes the step, the ambiguities make up for it,
// and the carriers go on as before. What the codes tell of the step is noisy, which both share in
// opposite senses; whole milliseconds are exact. Returns the step.
double Ekf::apply_code_step(const MeasurementEpoch& epoch, int base, const CommonStep& step) {
  const double whole_m = kMillisecond_m * std::round(step.value_m / kMillisecond_m);
  const bool exact =
      whole_m != 0.0 && std::abs(step.value_m - whole_m) < kExactSigmas * step.sigma_m;
  const double shift_m = exact ? whole_m : step.value_m;
  EkfCorrection direction = EkfCorrection::Zero(covariance_.rows());
  for (std::size_t i = 0; i < kMaxTimeBases; ++i)
    if (known_clocks_.offset[i] && is_base(static_cast<int>(i), base))
      direction(kClock + static_cast<int>(i)) = 1.0;
  for (std::size_t i = 0; i < state_.ambiguities.size(); ++i)
    if (is_base(static_cast<int>(index_of(state_.ambiguities[i].satellite.system)), base))
      direction(state_.first_ambiguity() + static_cast<int>(i)) = -1.0;
  state_.clocks.offset_m += shift_m * direction.segment<4>(kClock);
  for (std::size_t i = 0; i < state_.ambiguities.size(); ++i)
    state_.ambiguities[i].value_m +=
        shift_m * direction(state_.first_ambiguity() + static_cast<int>(i));
  for (EkfCovariance* covariance : covariance_and_noise())
    if (!exact) *covariance += square(step_sigma(step)) * direction * direction.transpose();
  for (FilterMeasurement& m : measurements_)
    if (m.observable == Observable::kCode && is_base(base_of(m, epoch), base))
      m.innovation -= shift_m;
  return shift_m;
}

// A step that codes and carriers have made alike, of one base's clock or of all clocks together.
void Ekf::apply_clock_step(const MeasurementEpoch& epoch, int base, const CommonStep& step) {
  EkfVector direction = EkfVector::Zero();
  for (std::size_t i = 0; i < kMaxTimeBases; ++i)
    if (known_clocks_.offset[i] && is_base(static_cast<int>(i), base))
      direction(kClock + static_cast<int>(i)) = 1.0;
  state_.clocks.offset_m += step.value_m * direction.segment<4>(kClock);
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->topLeftCorner<kSize, kSize>() +=
        square(step_sigma(step)) * direction * direction.transpose();
  for (FilterMeasurement& m : measurements_) {
    if (m.observable == Observable::kDoppler || !is_base(base_of(m, epoch), base)) continue;
    // An arc that begins here was begun with the clock as predicted.
    if (m.ambiguity >= 0 && covariance_(m.ambiguity, m.ambiguity) >= kUnknownAmbiguityVariance)
      state_.ambiguities[static_cast<std::size_t>(m.ambiguity - state_.first_ambiguity())]
          .value_m -= step.value_m;
    else
      m.innovation -= step.value_m;
  }
}

// Of all clocks: first what the codes did without the carriers, then what both did.
void Ekf::compensate_clock_jump(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  std::optional<CommonStep> step = code_step(measurements_, epoch, kAllBases, covariance_);
  double jump_m = common_shift(measurements_, Observable::kCode, covariance_);
  if (!step && jump_m != 0.0) {
    // Too few carriers to find small steps still say whether they have made this large one.
    const auto apart_m = median_code_minus_carrier(measurements_, epoch, covariance_);
    if (apart_m && std::abs(*apart_m) > 0.5 * std::abs(jump_m))
      step = CommonStep{*apart_m, kRoughStepSigma};
  }
  if (step) {
    result->code_step_m = apply_code_step(epoch, kAllBases, *step);
    jump_m = common_shift(measurements_, Observable::kCode, covariance_);
  }
  // The part of the shift that was not the clock's is left to the update to find.
  if (jump_m != 0.0) apply_clock_step(epoch, kAllBases, {jump_m, 0.0});
  result->clock_jump_m = result->code_step_m + jump_m;
}

// Of one base against the others. A step that its carriers do not make is the codes' and certain at
// once, and so is one far beyond what reflections that all its satellites share make. Any other may
// be such a fault of this epoch: the weights of the update judge it, and the next epoch tells. Not
// where the prediction is vague: such a fault would move the position by its size, and a base that
// is free of the others does not.
void Ekf::compensate_inter_system_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  const int reference = largest_base(measurements_, epoch);
  for (int base = 0; base < static_cast<int>(kMaxTimeBases); ++base) {
    const auto i = static_cast<std::size_t>(base);
    const double before_m = std::exchange(pending_inter_system_step_m_[i], 0.0);
    if (!known_clocks_.offset[i]) continue;
    if (const auto step = code_step(measurements_, epoch, base, covariance_))
      result->inter_system_step_m[i] += apply_code_step(epoch, base, *step);
    if (base == reference) continue;
    const InterSystemStep found =
        inter_system_step(measurements_, epoch, base, reference, covariance_);
    const bool vague = found.predicted_sigma_m > kVagueSigma_m;
    const auto step = vague ? fitted_inter_system_step(config_.robust, measurements_, epoch, base,
                                                       reference, covariance_, &robust_update_)
                            : found.step;
    if (!step) continue;
    const double size_m = std::abs(step->value_m);
    const bool certain = vague || size_m > kCertainSigmas * step->sigma_m;
    if (certain || std::abs(step->value_m - before_m) < kSameStepShare * size_m) {
      apply_clock_step(epoch, base, *step);
      result->inter_system_step_m[i] += step->value_m;
    } else {
      pending_inter_system_step_m_[i] = step->value_m;
    }
  }
}

// What no step explains, too few codes for one or a prediction that was wrong meanwhile: a base of
// which no code is accepted while most of the others' are has lost its offset.
void Ekf::count_epochs_without_accepted_code(const std::array<int, kMaxTimeBases>& offered,
                                             const std::array<int, kMaxTimeBases>& accepted) {
  const int all = std::accumulate(offered.begin(), offered.end(), 0);
  const int good = std::accumulate(accepted.begin(), accepted.end(), 0);
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    const int others = all - offered[base];
    const bool others_agree = others >= kMinOthers && 3 * good >= 2 * others;
    if (offered[base] > 0 && accepted[base] == 0 && others_agree)
      ++epochs_without_accepted_code_[base];
    else if (accepted[base] > 0)
      epochs_without_accepted_code_[base] = 0;
  }
}

// It starts anew, and so do its arcs: they have been found with its old offset.
void Ekf::restart_rejected_clocks() {
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (epochs_without_accepted_code_[base] < kMaxEpochsWithoutAcceptedCode) continue;
    epochs_without_accepted_code_[base] = kClockRestarts;
    known_clocks_.offset[base] = false;
    for (int i = static_cast<int>(state_.ambiguities.size()) - 1; i >= 0; --i)
      if (index_of(state_.ambiguities[static_cast<std::size_t>(i)].satellite.system) == base)
        drop_ambiguity(i);
  }
}

void Ekf::restart_clock_offsets() {
  for (std::size_t base = 0; base < kMaxTimeBases; ++base)
    if (known_clocks_.offset[base])
      epochs_without_accepted_code_[base] = kMaxEpochsWithoutAcceptedCode;
}

void Ekf::compensate_clock_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  compensate_clock_jump(epoch, result);
  compensate_inter_system_steps(epoch, result);
}

}  // namespace leonav
