// The clocks of Ekf: their start, and the steps that their noise does not hold.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/ekf/ambiguities.h"
#include "core/ekf/clock_free.h"
#include "core/ekf/clock_model.h"
#include "core/ekf/clock_steps.h"
#include "core/ekf/ekf.h"
#include "core/ekf/prediction_check.h"
#include "core/median.h"

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
constexpr int kLockedOutEpochs = 10;
constexpr int kStartsAnew = -1;         // instead of a count
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

double square(double x) { return x * x; }

// The step may be off by as much as it is large, up to what no noise of codes reaches: found in the
// measurements that the update is to use, its value is theirs to find.
double step_sigma(const CommonStep& step) {
  return std::max(std::min(std::abs(step.value_m), kMaxJumpSigma), step.sigma_m);
}

}  // namespace

void Ekf::start_offset(std::size_t base, double offset_m, double sigma_m) {
  start_clock_offset(base, offset_m, sigma_m, &now_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClock + static_cast<Eigen::Index>(base), square(sigma_m));
}

void Ekf::start_drift(std::size_t base, double drift_m_s, double sigma_m_s) {
  start_clock_drift(base, drift_m_s, sigma_m_s, &now_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClockDrift + static_cast<Eigen::Index>(base), square(sigma_m_s));
}

void Ekf::copy_drift(std::size_t from, std::size_t to, double sigma_m_s) {
  copy_clock_drift(from, to, sigma_m_s, &now_.clocks, &covariance_);
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
    if (known_.offset[base]) continue;
    const auto code = start_from(measurements_, epoch, Observable::kCode, base);
    const auto doppler = start_from(measurements_, epoch, Observable::kDoppler, base);
    if (!code && !doppler) continue;
    if (!known_.drift[base]) {
      std::size_t other = 0;
      while (other < kMaxTimeBases && !known_.drift[other]) ++other;
      if (other < kMaxTimeBases)
        copy_drift(other, base, kInterSystemDriftSigma);
      else if (doppler)
        start_drift(base, now_.clocks.drift_m_s(static_cast<Eigen::Index>(base)) + doppler->value,
                    kStartDriftSigma + doppler->sigma);
      else
        start_drift(base, 0.0, kUnknownDrift);
      known_.drift[base] = true;
      started = true;
    }
    if (code) {
      start_offset(base, now_.clocks.offset_m(static_cast<Eigen::Index>(base)) + code->value,
                   kStartClockSigma + code->sigma);
      known_.offset[base] = true;
      if (locked_out_[base] == kStartsAnew) result->base_step_m[base] = code->value;
      locked_out_[base] = 0;
      started = true;
    }
  }
  return started;
}

// Codes that step against their carriers: the clock takes the step, the ambiguities make up for it,
// and the carriers go on as before. What the codes tell of the step is noisy, which both share in
// opposite senses; whole milliseconds are exact. Returns the step.
double Ekf::take_up_code_step(const MeasurementEpoch& epoch, int base, const CommonStep& step) {
  const double whole_m = kMillisecond_m * std::round(step.value_m / kMillisecond_m);
  const bool exact =
      whole_m != 0.0 && std::abs(step.value_m - whole_m) < kExactSigmas * step.sigma_m;
  const double shift_m = exact ? whole_m : step.value_m;
  EkfCorrection direction = EkfCorrection::Zero(covariance_.rows());
  for (std::size_t i = 0; i < kMaxTimeBases; ++i)
    if (known_.offset[i] && is_base(static_cast<int>(i), base))
      direction(kClock + static_cast<int>(i)) = 1.0;
  for (std::size_t i = 0; i < now_.ambiguities.size(); ++i)
    if (is_base(static_cast<int>(index_of(now_.ambiguities[i].satellite.system)), base))
      direction(now_.first_ambiguity() + static_cast<int>(i)) = -1.0;
  now_.clocks.offset_m += shift_m * direction.segment<4>(kClock);
  for (std::size_t i = 0; i < now_.ambiguities.size(); ++i)
    now_.ambiguities[i].value_m +=
        shift_m * direction(now_.first_ambiguity() + static_cast<int>(i));
  for (EkfCovariance* covariance : with_noise())
    if (!exact) *covariance += square(step_sigma(step)) * direction * direction.transpose();
  for (FilterMeasurement& m : measurements_)
    if (m.observable == Observable::kCode && is_base(base_of(m, epoch), base))
      m.innovation -= shift_m;
  return shift_m;
}

// A step that codes and carriers have made alike, of one base's clock or of all clocks together.
void Ekf::take_up_clock_step(const MeasurementEpoch& epoch, int base, const CommonStep& step) {
  EkfVector direction = EkfVector::Zero();
  for (std::size_t i = 0; i < kMaxTimeBases; ++i)
    if (known_.offset[i] && is_base(static_cast<int>(i), base))
      direction(kClock + static_cast<int>(i)) = 1.0;
  now_.clocks.offset_m += step.value_m * direction.segment<4>(kClock);
  for (EkfCovariance* covariance : with_noise())
    covariance->topLeftCorner<kSize, kSize>() +=
        square(step_sigma(step)) * direction * direction.transpose();
  for (FilterMeasurement& m : measurements_) {
    if (m.observable == Observable::kDoppler || !is_base(base_of(m, epoch), base)) continue;
    // An arc that begins here was begun with the clock as predicted.
    if (m.ambiguity >= 0 && covariance_(m.ambiguity, m.ambiguity) >= kUnknownAmbiguity)
      now_.ambiguities[static_cast<std::size_t>(m.ambiguity - now_.first_ambiguity())].value_m -=
          step.value_m;
    else
      m.innovation -= step.value_m;
  }
}

// Of all clocks: first what the codes did without the carriers, then what both did.
void Ekf::take_up_clock_jump(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  std::optional<CommonStep> step = code_step(measurements_, epoch, kAllBases, covariance_);
  double jump_m = common_shift(measurements_, Observable::kCode, covariance_);
  if (!step && jump_m != 0.0) {
    // Too few carriers to find small steps still say whether they have made this large one.
    const auto apart_m = median_code_less_carrier(measurements_, epoch, covariance_);
    if (apart_m && std::abs(*apart_m) > 0.5 * std::abs(jump_m))
      step = CommonStep{*apart_m, kRoughStepSigma};
  }
  if (step) {
    result->code_step_m = take_up_code_step(epoch, kAllBases, *step);
    jump_m = common_shift(measurements_, Observable::kCode, covariance_);
  }
  // The part of the shift that was not the clock's is left to the update to find.
  if (jump_m != 0.0) take_up_clock_step(epoch, kAllBases, {jump_m, 0.0});
  result->clock_jump_m = result->code_step_m + jump_m;
}

// Of one base against the others. A step that its carriers do not make is the codes' and certain at
// once, and so is one far beyond what reflections that all its satellites share make. Any other may
// be such a fault of this epoch: the weights of the update judge it, and the next epoch tells. Not
// where the prediction is vague: such a fault would move the position by its size, and a base that
// is free of the others does not.
void Ekf::take_up_base_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  const int reference = largest_base(measurements_, epoch);
  for (int base = 0; base < static_cast<int>(kMaxTimeBases); ++base) {
    const auto i = static_cast<std::size_t>(base);
    const double before_m = std::exchange(base_apart_m_[i], 0.0);
    if (!known_.offset[i]) continue;
    if (const auto step = code_step(measurements_, epoch, base, covariance_))
      result->base_step_m[i] += take_up_code_step(epoch, base, *step);
    if (base == reference) continue;
    const BaseStep found = base_step(measurements_, epoch, base, reference, covariance_);
    const bool vague = found.predicted_sigma_m > kVagueSigma_m;
    const auto step = vague ? fitted_base_step(config_.robust, measurements_, epoch, base,
                                               reference, covariance_, &robust_update_)
                            : found.step;
    if (!step) continue;
    const double size_m = std::abs(step->value_m);
    const bool certain = vague || size_m > kCertainSigmas * step->sigma_m;
    if (certain || std::abs(step->value_m - before_m) < kSameStepShare * size_m) {
      take_up_clock_step(epoch, base, *step);
      result->base_step_m[i] += step->value_m;
    } else {
      base_apart_m_[i] = step->value_m;
    }
  }
}

// What no step explains, too few codes for one or a prediction that was wrong meanwhile: a base of
// which no code is accepted while most of the others' are has lost its offset.
void Ekf::watch_bases(const std::array<int, kMaxTimeBases>& offered,
                      const std::array<int, kMaxTimeBases>& accepted) {
  const int all = std::accumulate(offered.begin(), offered.end(), 0);
  const int good = std::accumulate(accepted.begin(), accepted.end(), 0);
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    const int others = all - offered[base];
    const bool others_agree = others >= kMinOthers && 3 * good >= 2 * others;
    if (offered[base] > 0 && accepted[base] == 0 && others_agree)
      ++locked_out_[base];
    else if (accepted[base] > 0)
      locked_out_[base] = 0;
  }
}

// It starts anew, and so do its arcs: they have been found with its old offset.
void Ekf::forget_locked_out_bases() {
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (locked_out_[base] < kLockedOutEpochs) continue;
    locked_out_[base] = kStartsAnew;
    known_.offset[base] = false;
    for (int i = static_cast<int>(now_.ambiguities.size()) - 1; i >= 0; --i)
      if (index_of(now_.ambiguities[static_cast<std::size_t>(i)].satellite.system) == base)
        forget_ambiguity(i);
  }
}

void Ekf::forget_clocks() {
  for (std::size_t base = 0; base < kMaxTimeBases; ++base)
    if (known_.offset[base]) locked_out_[base] = kLockedOutEpochs;
}

void Ekf::take_up_clock_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result) {
  take_up_clock_jump(epoch, result);
  take_up_base_steps(epoch, result);
}

}  // namespace leonav
