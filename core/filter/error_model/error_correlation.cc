#include "core/filter/error_model/error_correlation.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr std::array<double, 15> kTimes_s = {1.5,  2.1,  3.0,  4.2,  6.0,  8.5,   12.0, 17.0,
                                             24.0, 34.0, 48.0, 68.0, 96.0, 136.0, 192.0};
constexpr double kMemory_s = 240.0;
constexpr double kSpacing_s = 0.9;       // samples of a signal that are kept are this far apart
constexpr double kMostInnovation = 5.0;  // of a standardized innovation
// Pairs that what is known beforehand counts as.
constexpr double kPriorPairs = 150.0;
constexpr double kLeastVariance = 0.05;

// Returns the bin of a lag: 1, 2, 3-4, 5-8, ... s.
std::size_t bin_of(double lag_s, std::size_t bins) {
  const double bin = 1.0 + std::max(0.0, std::ceil(std::log2(std::max(lag_s - 0.5, 0.5))));
  return std::min(static_cast<std::size_t>(bin), bins - 1);
}

// Autocorrelation by lag, with the number of pairs that it rests on.
template <std::size_t kBins>
struct Correlogram {
  double variance = 1.0;  // of standardized errors
  std::array<double, kBins> rho{}, lag_s{}, pairs{};
};

// That of a model, as if it had been seen in kPriorPairs pairs of each bin.
template <std::size_t kBins>
Correlogram<kBins> correlogram_of(const CorrelationModel& model) {
  Correlogram<kBins> correlogram;
  correlogram.pairs.fill(kPriorPairs);
  for (std::size_t i = 1; i < kBins; ++i) {
    correlogram.lag_s[i] = std::exp2(static_cast<double>(i) - 1.0);
    if (model.time_s > 0.0)
      correlogram.rho[i] = model.share * std::exp(-correlogram.lag_s[i] / model.time_s);
  }
  return correlogram;
}

// Returns what sums of products say, with `prior` counting as kPriorPairs pairs.
template <typename Lags, std::size_t kBins>
Correlogram<kBins> updated(const Correlogram<kBins>& prior, const Lags& sums) {
  Correlogram<kBins> result;
  result.variance = std::max(kLeastVariance, (sums[0].product + kPriorPairs * prior.variance) /
                                                 (sums[0].count + kPriorPairs));
  for (std::size_t i = 1; i < kBins; ++i) {
    const double pairs = sums[i].count + kPriorPairs;
    result.pairs[i] = pairs;
    result.rho[i] = (sums[i].product / result.variance + kPriorPairs * prior.rho[i]) / pairs;
    result.lag_s[i] = (sums[i].lag_s + kPriorPairs * prior.lag_s[i]) / pairs;
  }
  return result;
}

// Fits share and time by least squares, weighted by pairs.
template <std::size_t kBins>
CorrelationModel fit(const Correlogram<kBins>& correlogram) {
  CorrelationModel best;
  double least = 0.0;  // of the sum of squares, less that of share 0
  for (const double time_s : kTimes_s) {
    double seen = 0.0, expected = 0.0;
    for (std::size_t i = 1; i < kBins; ++i) {
      const double shape = std::exp(-correlogram.lag_s[i] / time_s);
      seen += correlogram.pairs[i] * correlogram.rho[i] * shape;
      expected += correlogram.pairs[i] * shape * shape;
    }
    if (!(expected > 0.0)) continue;
    const double share = std::clamp(seen / expected, 0.0, 1.0);
    const double sum = share * share * expected - 2.0 * share * seen;
    if (sum < least) {
      least = sum;
      best = {share, time_s};
    }
  }
  // Errors smaller than their sigma cost a mean less: their correlated part is a smaller share of
  // it.
  best.share *= std::min(correlogram.variance, 1.0);
  return best;
}

// Returns the one with the larger inflation of variance at 1 Hz.
const CorrelationModel& longer_lasting(const CorrelationModel& prior,
                                       const CorrelationModel& seen) {
  return variance_inflation(seen, 1.0) > variance_inflation(prior, 1.0) ? seen : prior;
}

}  // namespace

double variance_inflation(const CorrelationModel& model, double dt) {
  if (model.time_s <= 0.0 || dt <= 0.0) return 1.0;
  const double r = std::exp(-dt / model.time_s);
  return (1.0 + (2.0 * model.share - 1.0) * r) / (1.0 - r);
}

ErrorCorrelation::ErrorCorrelation(const Priors& priors)
    : priors_(priors), histories_(std::make_unique<Histories>()) {
  reset();
}

void ErrorCorrelation::reset() {
  histories_->entries.clear();
  lags_ = {};
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    for (std::size_t motion = 0; motion < kMotionClasses; ++motion)
      models_[kind][motion].fill(priors_[kind][motion]);
}

ErrorCorrelation::History* ErrorCorrelation::history_of(const Sample& sample, GpsTime time) {
  auto& entries = histories_->entries;
  for (History& entry : entries)
    if (entry.satellite == sample.satellite && entry.code == sample.code &&
        entry.observable == sample.of.observable)
      return &entry;
  History* entry = nullptr;
  if (entries.size() < entries.capacity()) {
    entries.push_back({});
    entry = &entries.back();
  } else {
    entry = &*std::min_element(entries.begin(), entries.end(),
                               [](const History& a, const History& b) { return a.last < b.last; });
    if (!(entry->last < time)) return nullptr;
  }
  entry->satellite = sample.satellite;
  entry->code = sample.code;
  entry->observable = sample.of.observable;
  entry->last = GpsTime();
  entry->next = entry->count = 0;
  return entry;
}

void ErrorCorrelation::add(const Sample& sample, GpsTime time) {
  History* history = history_of(sample, time);
  if (history == nullptr) return;
  if (history->last.is_set() && seconds_between(time, history->last) < kSpacing_s) return;
  history->last = time;
  const double u = std::clamp(sample.ratio, -kMostInnovation, kMostInnovation);
  Lags& lags = lags_[sample.of.observable][sample.of.motion][sample.of.elevation];
  lags[0].count += 1.0;
  lags[0].product += u * u;
  for (std::size_t i = 0; i < history->count; ++i) {
    const Past& past = history->past[i];
    if (past.motion != sample.of.motion) continue;
    const double lag_s = seconds_between(time, past.time);
    Lag& lag = lags[bin_of(lag_s, kLags)];
    lag.count += 1.0;
    lag.lag_s += lag_s;
    lag.product += u * past.ratio;
  }
  history->past[history->next] = {time, u, sample.of.motion};
  history->next = (history->next + 1) % kHistory;
  history->count = std::min(history->count + 1, kHistory);
}

void ErrorCorrelation::end_epoch(double interval_s) {
  const double keep = std::exp(-std::max(interval_s, 0.0) / kMemory_s);
  for (std::size_t kind = 0; kind < kObservables; ++kind) {
    for (std::size_t motion = 0; motion < kMotionClasses; ++motion) {
      Lags all{};
      for (const Lags& of_class : lags_[kind][motion])
        for (std::size_t i = 0; i < kLags; ++i) all[i] += of_class[i];
      const auto of_observable = updated(correlogram_of<kLags>(priors_[kind][motion]), all);
      for (std::size_t elevation = 0; elevation < kElevationClasses; ++elevation) {
        Lags& own = lags_[kind][motion][elevation];
        models_[kind][motion][elevation] =
            longer_lasting(priors_[kind][motion], fit(updated(of_observable, own)));
        for (Lag& lag : own) lag *= keep;
      }
    }
  }
}

}  // namespace leonav
