#include "core/filter/error_model/sigma_scale.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

// Until something has been seen, errors are taken to be larger than configured: a street is more
// usual than an open place, and information with too small a variance stays in the state.
constexpr double kStartScale = 2.0;
constexpr double kLimit = 2.5;         // k
constexpr double kExpected = 0.97756;  // beta: of a standard normal z
constexpr double kBaseTime_s = 20.0, kTermTime_s = 60.0;
constexpr double kYoungest_s = 3.0;
constexpr double kReturnTime_s = 1200.0;
constexpr double kFewSamples = 2.0;  // count half
constexpr double kLargestStep = 0.2;
constexpr double kSmallestLog = -1.1, kLargestLog = 2.3;  // a third to ten times

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
  term->value = std::clamp(term->value, kSmallestLog, kLargestLog);
  term->score = 0.0;
  term->count = 0;
}

}  // namespace

SigmaScale::SigmaScale() {
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    if (kind != static_cast<std::size_t>(Observable::kCarrier))
      terms_[kind].base.value = std::log(kStartScale);
}

void SigmaScale::add(const Sample& sample) {
  Terms& terms = terms_[sample.of.observable];
  const double score =
      sample.measured_share * (std::min(sample.squared_ratio, kLimit * kLimit) - kExpected);
  for (Term* term : {&terms.base, &terms.system[sample.of.system],
                     &terms.elevation[sample.of.elevation], &terms.signal[sample.of.signal]}) {
    term->score += score;
    ++term->count;
  }
}

void SigmaScale::end_epoch(double interval_s) {
  for (Terms& terms : terms_) {
    advance(interval_s, kBaseTime_s, 0.0, &terms.base);
    for (Term& term : terms.system) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
    for (Term& term : terms.elevation) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
    for (Term& term : terms.signal) advance(interval_s, kTermTime_s, kReturnTime_s, &term);
  }
}

double SigmaScale::mean_scale(Observable observable) const {
  return std::exp(terms_[static_cast<std::size_t>(observable)].base.value);
}

double SigmaScale::scale(const ErrorClass& of) const {
  const Terms& terms = terms_[of.observable];
  const double sum = terms.base.value + terms.system[of.system].value +
                     terms.elevation[of.elevation].value + terms.signal[of.signal].value;
  return std::exp(std::clamp(sum, kSmallestLog, kLargestLog));
}

}  // namespace leonav
