#include "core/filter/error_model/sigma_scale.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

// Until something has been seen, errors are taken to be larger than configured: a street is more
// usual than an open place, and information with too small a variance stays in the state.
constexpr double kStartScale = 2.0;
constexpr double kMostRatio = 2.5;     // k
constexpr double kExpected = 0.97756;  // beta: of a standard normal z
constexpr double kBaseTime_s = 20.0, kTermTime_s = 60.0;
constexpr double kYoungest_s = 3.0;
constexpr double kReturnTime_s = 1200.0;
constexpr double kFewSamples = 2.0;  // count half
constexpr double kLargestStep = 0.2;
constexpr std::size_t kMinToStart = 8;
constexpr int kStartPasses = 30;
constexpr double kStartShrinkage = 4.0;  // samples at the value a term has beforehand
constexpr double kSmallestLog = 0.0, kLargestLog = 3.4;  // one to thirty times

// While a term is young its time is its age: it then is the plain mean of what was seen.
template <typename Term>
void advance(double interval_s, double time_s, double return_s, Term* term) {
  if (term->count > 0) {
    term->age_s += interval_s;
    const double mean = term->score / (term->count + kFewSamples);
    const double step = 0.5 * mean * interval_s / std::clamp(term->age_s, kYoungest_s, time_s);
    term->value += std::clamp(step, -kLargestStep, kLargestStep);
  }
  if (return_s > 0.0) term->value *= std::exp(-interval_s / return_s);
  term->value = std::clamp(term->value, -kLargestLog, kLargestLog);
  term->score = 0.0;
  term->count = 0;
}

}  // namespace

SigmaScale::SigmaScale() {
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    if (kind != static_cast<std::size_t>(Observable::kCarrier))
      terms_[kind].base.value = std::log(kStartScale);
}

void SigmaScale::start(Observable observable, double scale, double share) {
  terms_[static_cast<std::size_t>(observable)].base.value = std::clamp(
      share * std::log(scale) + (1.0 - share) * std::log(kStartScale), kSmallestLog, kLargestLog);
}

bool SigmaScale::fit_first(Observable observable, std::span<const Sample> samples) {
  if (samples.size() < kMinToStart) return false;
  Terms& terms = terms_[static_cast<std::size_t>(observable)];
  struct Sum {
    double score = 0.0, count = 0.0;
  };
  // Returns the step of a scoring iteration (Fisher information of log s: 2 per sample).
  const auto step = [](const Sum& sum, double value, double prior) {
    return 0.5 * (sum.score - 2.0 * kStartShrinkage * (value - prior)) /
           (sum.count + kStartShrinkage);
  };
  const double start = terms.base.value;
  terms.base.age_s = kYoungest_s;  // what the fit counts as
  for (int pass = 0; pass < kStartPasses; ++pass) {
    Sum all;
    std::array<Sum, kElevationClasses> of_elevation{};
    for (const Sample& sample : samples) {
      const double ratio = sample.squared_ratio / square(scale(sample.of));
      for (Sum* sum : {&all, &of_elevation[sample.of.elevation]}) {
        sum->score += score(sample.of, ratio);
        sum->count += 1.0;
      }
    }
    // Alternately, because what one term explains is not for the other.
    if (pass % 2 == 0) {
      terms.base.value += step(all, terms.base.value, start);
    } else {
      for (std::size_t i = 0; i < kElevationClasses; ++i)
        terms.elevation[i].value += step(of_elevation[i], terms.elevation[i].value, 0.0);
    }
  }
  terms.base.value = std::clamp(terms.base.value, kSmallestLog, kLargestLog);
  return true;
}

void SigmaScale::add(const Sample& sample) {
  Terms& terms = terms_[sample.of.observable];
  const double weighted = sample.measured_share * score(sample.of, sample.squared_ratio);
  for (Term* term :
       {&terms.base, &terms.system[sample.of.system], &terms.elevation[sample.of.elevation],
        &terms.signal[sample.of.signal], &terms.loss[sample.of.loss]}) {
    term->score += weighted;
    ++term->count;
  }
}

void SigmaScale::end_epoch(double interval_s) {
  for (Terms& terms : terms_) {
    advance(interval_s, kBaseTime_s, 0.0, &terms.base);
    terms.base.value = std::max(terms.base.value, kSmallestLog);
    for (Term& term : terms.system) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
    for (Term& term : terms.elevation) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
    for (Term& term : terms.signal) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
    for (Term& term : terms.loss) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
  }
}

double SigmaScale::mean_scale(Observable observable) const {
  return std::exp(terms_[static_cast<std::size_t>(observable)].base.value);
}

double SigmaScale::sum_of_terms(const ErrorClass& of) const {
  const Terms& terms = terms_[of.observable];
  return terms.base.value + terms.system[of.system].value + terms.elevation[of.elevation].value +
         terms.signal[of.signal].value + terms.loss[of.loss].value;
}

double SigmaScale::score(const ErrorClass& of, double squared_ratio) const {
  const double score = std::min(squared_ratio, kMostRatio * kMostRatio) - kExpected;
  return sum_of_terms(of) > kSmallestLog ? score : std::max(score, 0.0);
}

double SigmaScale::scale(const ErrorClass& of) const {
  return std::exp(std::clamp(sum_of_terms(of), kSmallestLog, kLargestLog));
}

void SigmaScale::summarize(Observable observable, ObservableErrors* summary) const {
  const Terms& terms = terms_[static_cast<std::size_t>(observable)];
  summary->all.sigma_factor = mean_scale(observable);
  std::size_t next = 0;
  const auto add = [&](const auto& of_property) {
    for (const Term& term : of_property)
      summary->classes[next++].sigma_factor =
          std::exp(std::clamp(terms.base.value + term.value, kSmallestLog, kLargestLog));
  };
  add(terms.system);
  add(terms.elevation);
  add(terms.signal);
  add(terms.loss);
}

}  // namespace leonav
