#include "core/filter/receiver_clocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/median.h"
#include "core/filter/carrier_ambiguities.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "core/filter/innovation_tests/prediction_consistency.h"
#include "core/filter/state/clock_model.h"

namespace leonav {
namespace {

using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

// m, of a new system's offset: so wide that the measurements it was started from are hardly counted
// twice.
constexpr double kStartClockSigma = 100.0;
constexpr double kStartDriftSigma = 10.0;       // m/s, for the same reason
constexpr double kInterSystemDriftSigma = 1.0;  // m/s, between the drifts of two systems
constexpr double kMaxJumpSigma = 100.0;         // m, inflation of the clocks after a jump
constexpr double kMadToSigma = 1.4826;
constexpr double kMillisecond_m = 299'792.458;
constexpr double kExactSigmas = 5.0;      // nearer to whole milliseconds, a step is taken as these
constexpr double kRoughStepSigma = 10.0;  // m, of a step found with fewer than four satellites
// Codes of one system in a street have been seen 5.5 sigma off the others' for an epoch.
constexpr double kCertainSigmas = 15.0;
constexpr double kSameStepShare = 0.5;  // steps of two epochs that differ by less of them are one
// So long that a passing reflection at 1 Hz is over.
constexpr int kMaxEpochsWithoutAcceptedCode = 10;
constexpr int kMinOthers = 4;           // codes that stand against a system
constexpr double kVagueSigma_m = 20.0;  // of a prediction that does not see a system's step

struct Start {
  double value = 0.0;
  double sigma = 0.0;
};

// Returns where a clock state should start so that most innovations of its system vanish.
std::optional<Start> start_from(const FilterMeasurements& measurements,
                                const MeasurementEpoch& epoch, Observable observable,
                                std::size_t system) {
  SmallTable innovations;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable == observable &&
        system_of(measurement, epoch) == static_cast<int>(system))
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

// The step may be off by as much as it is large, up to what no noise of codes reaches: it was found
// in the measurements that the update is to use, and its value is theirs to find.
double step_sigma(const CommonStep& step) {
  return std::max(std::min(std::abs(step.value_m), kMaxJumpSigma), step.sigma_m);
}

}  // namespace

void ReceiverClocks::reset() {
  pending_inter_system_step_m_ = {};
  epochs_without_accepted_code_ = {};
  restarting_ = {};
}

bool ReceiverClocks::start(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                           StateEstimate* estimate, ClockSteps* steps) {
  const ClockFlags& known = estimate->known_clocks();
  const ClockState& clocks = estimate->state().clocks;
  bool started = false;
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    if (known.offset[system]) continue;
    const auto code = start_from(measurements, epoch, Observable::kCode, system);
    const auto doppler = start_from(measurements, epoch, Observable::kDoppler, system);
    if (!code && !doppler) continue;
    const auto i = static_cast<Eigen::Index>(system);
    if (!known.drift[system]) {
      std::size_t other = 0;
      while (other < kMaxSystemTimes && !known.drift[other]) ++other;
      if (other < kMaxSystemTimes)
        estimate->copy_clock_drift(other, system, kInterSystemDriftSigma);
      else if (doppler)
        estimate->start_clock_drift(system, clocks.drift_m_s(i) + doppler->value,
                                    kStartDriftSigma + doppler->sigma);
      else
        estimate->start_clock_drift(system, 0.0, kUnknownDriftSigma);
      started = true;
    }
    if (code) {
      estimate->start_clock_offset(system, clocks.offset_m(i) + code->value,
                                   kStartClockSigma + code->sigma);
      if (restarting_[system]) steps->inter_system_step_m[system] = code->value;
      restarting_[system] = false;
      epochs_without_accepted_code_[system] = 0;
      started = true;
    }
  }
  return started;
}

// Codes that step against their carriers: the clock takes the step, the ambiguities make up for it,
// and the carriers go on as before. Whole milliseconds are exact. Returns the step.
double ReceiverClocks::apply_code_step(const MeasurementEpoch& epoch, int system,
                                       const CommonStep& step, FilterMeasurements* measurements,
                                       StateEstimate* estimate) {
  const double whole_m = kMillisecond_m * std::round(step.value_m / kMillisecond_m);
  const bool exact =
      whole_m != 0.0 && std::abs(step.value_m - whole_m) < kExactSigmas * step.sigma_m;
  const double shift_m = exact ? whole_m : step.value_m;
  estimate->shift_codes_against_carriers(system, shift_m, exact ? 0.0 : step_sigma(step));
  for (FilterMeasurement& m : *measurements)
    if (m.observable == Observable::kCode && is_of(system_of(m, epoch), system))
      m.innovation -= shift_m;
  return shift_m;
}

// A step that codes and carriers have made alike, of one system's clock or of all clocks together.
void ReceiverClocks::apply_clock_step(const MeasurementEpoch& epoch, int system,
                                      const CommonStep& step, FilterMeasurements* measurements,
                                      StateEstimate* estimate) {
  estimate->shift_clocks(system, step.value_m, step_sigma(step));
  for (FilterMeasurement& m : *measurements) {
    if (m.observable == Observable::kDoppler || !is_of(system_of(m, epoch), system)) continue;
    // An arc that begins here was begun with the clock as predicted.
    const bool begins =
        m.observable == Observable::kCarrier &&
        estimate->covariance()(m.signal_state, m.signal_state) >= kUnknownAmbiguityVariance;
    if (begins)
      estimate->shift_signal_state(m.signal_state, -step.value_m);
    else
      m.innovation -= step.value_m;
  }
}

// Of all clocks: first what the codes did without the carriers, then what both did.
void ReceiverClocks::compensate_jump(const MeasurementEpoch& epoch,
                                     FilterMeasurements* measurements, StateEstimate* estimate,
                                     ClockSteps* steps) {
  const EkfCovariance& covariance = estimate->covariance();
  std::optional<CommonStep> step = code_step(*measurements, epoch, kAllSystems, covariance);
  double jump_m = common_shift(*measurements, Observable::kCode, covariance);
  if (!step && jump_m != 0.0) {
    // Too few carriers to find small steps still show whether they have made this large one.
    const auto offset_m = median_code_minus_carrier(*measurements, epoch, covariance);
    if (offset_m && std::abs(*offset_m) > 0.5 * std::abs(jump_m))
      step = CommonStep{*offset_m, kRoughStepSigma};
  }
  if (step) {
    steps->code_step_m = apply_code_step(epoch, kAllSystems, *step, measurements, estimate);
    jump_m = common_shift(*measurements, Observable::kCode, covariance);
  }
  // The part of the shift that was not the clock's is left to the update to find.
  if (jump_m != 0.0) apply_clock_step(epoch, kAllSystems, {jump_m, 0.0}, measurements, estimate);
  steps->clock_jump_m = steps->code_step_m + jump_m;
}

// Of one system against the others. A step that its carriers do not make is the codes' and certain
// at once, and so is one far beyond what reflections shared by all its satellites make. Any other
// may be such a fault of this epoch: the weights of the update decide, and the next epoch
// confirms it or not. Where the prediction is vague there is no waiting: such a fault would move
// the position by its size, and a system that is free of the others does not.
void ReceiverClocks::compensate_inter_system_steps(const MeasurementEpoch& epoch,
                                                   RobustUpdate* robust_update,
                                                   FilterMeasurements* measurements,
                                                   StateEstimate* estimate, ClockSteps* steps) {
  const EkfCovariance& covariance = estimate->covariance();
  const int reference = largest_system(*measurements, epoch);
  for (int system = 0; system < static_cast<int>(kMaxSystemTimes); ++system) {
    const auto i = static_cast<std::size_t>(system);
    const double before_m = std::exchange(pending_inter_system_step_m_[i], 0.0);
    if (!estimate->known_clocks().offset[i]) continue;
    if (const auto step = code_step(*measurements, epoch, system, covariance))
      steps->inter_system_step_m[i] +=
          apply_code_step(epoch, system, *step, measurements, estimate);
    if (system == reference) continue;
    const InterSystemStep found =
        inter_system_step(*measurements, epoch, system, reference, covariance);
    const bool vague = found.predicted_sigma_m > kVagueSigma_m;
    const auto step = vague ? fitted_inter_system_step(robust_, *measurements, epoch, system,
                                                       reference, covariance, robust_update)
                            : found.step;
    if (!step) continue;
    const double size_m = std::abs(step->value_m);
    const bool certain = vague || size_m > kCertainSigmas * step->sigma_m;
    if (certain || std::abs(step->value_m - before_m) < kSameStepShare * size_m) {
      apply_clock_step(epoch, system, *step, measurements, estimate);
      steps->inter_system_step_m[i] += step->value_m;
    } else {
      pending_inter_system_step_m_[i] = step->value_m;
    }
  }
}

void ReceiverClocks::compensate_steps(const MeasurementEpoch& epoch, RobustUpdate* robust_update,
                                      FilterMeasurements* measurements, StateEstimate* estimate,
                                      ClockSteps* steps) {
  compensate_jump(epoch, measurements, estimate, steps);
  compensate_inter_system_steps(epoch, robust_update, measurements, estimate, steps);
}

// Too few codes for a step, or a prediction that was wrong meanwhile: a system of which no code is
// accepted while most of the others' are has lost its offset.
void ReceiverClocks::count_epochs_without_accepted_code(const Counts& offered,
                                                        const Counts& accepted) {
  const int all = std::accumulate(offered.begin(), offered.end(), 0);
  const int good = std::accumulate(accepted.begin(), accepted.end(), 0);
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    const int others = all - offered[system];
    const bool others_agree = others >= kMinOthers && 3 * good >= 2 * others;
    if (offered[system] > 0 && accepted[system] == 0 && others_agree)
      ++epochs_without_accepted_code_[system];
    else if (accepted[system] > 0)
      epochs_without_accepted_code_[system] = 0;
  }
}

void ReceiverClocks::restart_rejected(StateEstimate* estimate) {
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    if (epochs_without_accepted_code_[system] < kMaxEpochsWithoutAcceptedCode) continue;
    epochs_without_accepted_code_[system] = 0;
    restarting_[system] = true;
    estimate->forget_clock_offset(system);
    remove_ambiguities_of(system, estimate);
  }
}

void ReceiverClocks::restart_offsets(const ClockFlags& known) {
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system)
    if (known.offset[system]) epochs_without_accepted_code_[system] = kMaxEpochsWithoutAcceptedCode;
}

}  // namespace leonav
