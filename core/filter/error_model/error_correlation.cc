#include "core/filter/error_model/error_correlation.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr std::array<double, 7> kTimes_s = {1.5, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0};
constexpr double kMemory_s = 240.0;
constexpr double kSpacing_s = 0.9;  // samples of a signal that are kept are this far apart
constexpr double kLimit = 3.0;      // of a standardized innovation
// Pairs that what is known beforehand counts as.
constexpr double kPriorPairs = 150.0, kObservablePairs = 150.0;

// Returns the bin of a lag: 1, 2, 3-4, 5-8, ... s.
std::size_t bin_of(double lag_s, std::size_t bins) {
  const double bin = 1.0 + std::max(0.0, std::ceil(std::log2(std::max(lag_s - 0.5, 0.5))));
  return std::min(static_cast<std::size_t>(bin), bins - 1);
}

template <typename Lag>
void add_weighted(const Lag& from, double weight, Lag* to) {
  to->count += weight * from.count;
  to->product += weight * from.product;
  to->lag_s += weight * from.lag_s;
}

// Fits share and time to the bins by least squares, a weight for each bin's pairs.
template <typename Lags>
CorrelationModel fit(const Lags& lags) {
  CorrelationModel best;
  const double variance = lags[0].product / lags[0].count;
  if (!(variance > 0.0)) return best;
  double least = 0.0;  // of the sum of squares, less that of share 0
  for (const double time_s : kTimes_s) {
    double seen = 0.0, expected = 0.0;
    for (std::size_t i = 1; i < lags.size(); ++i) {
      if (!(lags[i].count > 0.0)) continue;
      const double shape = std::exp(-lags[i].lag_s / lags[i].count / time_s);
      seen += lags[i].product / variance * shape;
      expected += lags[i].count * shape * shape;
    }
    if (!(expected > 0.0)) continue;
    const double share = std::clamp(seen / expected, 0.0, 1.0);
    const double sum = share * share * expected - 2.0 * share * seen;
    if (sum < least) {
      least = sum;
      best = {share, time_s};
    }
  }
  return best;
}

}  // namespace

double variance_inflation(const CorrelationModel& model, double dt) {
  if (model.time_s <= 0.0 || dt <= 0.0) return 1.0;
  const double r = std::exp(-dt / model.time_s);
  return 1.0 + 2.0 * model.share * r / (1.0 - r);
}

ErrorCorrelation::ErrorCorrelation(const std::array<CorrelationModel, kObservables>& prior)
    : prior_(prior), histories_(std::make_unique<Histories>()) {
  reset();
}

void ErrorCorrelation::reset() {
  histories_->entries.clear();
  for (std::size_t kind = 0; kind < kObservables; ++kind) {
    lags_[kind] = {};
    models_[kind].fill(prior_[kind]);
  }
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
    entry = &*std::min_element(entries.begin(), entries.end(), [](const History& a,
                                                                  const History& b) {
      return a.last < b.last;
    });
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
  const double u = std::clamp(sample.ratio, -kLimit, kLimit);
  Lags& lags = lags_[sample.of.observable][sample.of.elevation];
  lags[0].count += 1.0;
  lags[0].product += u * u - sample.predicted_ratio;
  for (std::size_t i = 0; i < history->count; ++i) {
    const Past& past = history->past[i];
    const double lag_s = seconds_between(time, past.time);
    Lag& lag = lags[bin_of(lag_s, kLags)];
    lag.count += 1.0;
    lag.lag_s += lag_s;
    lag.product +=
        u * past.ratio - std::sqrt(sample.predicted_ratio * past.predicted_ratio);
  }
  history->past[history->next] = {time, u, sample.predicted_ratio};
  history->next = (history->next + 1) % kHistory;
  history->count = std::min(history->count + 1, kHistory);
}

// As many pairs as kPriorPairs in each bin, as the configured model would give them.
ErrorCorrelation::Lags ErrorCorrelation::prior_lags(std::size_t observable) const {
  const CorrelationModel& prior = prior_[observable];
  Lags lags;
  lags[0] = {kPriorPairs, kPriorPairs, 0.0};
  for (std::size_t i = 1; i < kLags; ++i) {
    const double lag_s = std::exp2(static_cast<double>(i) - 1.0);
    const double rho = prior.time_s > 0.0 ? prior.share * std::exp(-lag_s / prior.time_s) : 0.0;
    lags[i] = {kPriorPairs, kPriorPairs * rho, kPriorPairs * lag_s};
  }
  return lags;
}

void ErrorCorrelation::end_epoch(double interval_s) {
  const double keep = std::exp(-std::max(interval_s, 0.0) / kMemory_s);
  for (std::size_t kind = 0; kind < kObservables; ++kind) {
    Lags all = prior_lags(kind);
    for (const Lags& of_class : lags_[kind])
      for (std::size_t i = 0; i < kLags; ++i) add_weighted(of_class[i], 1.0, &all[i]);
    for (std::size_t elevation = 0; elevation < kElevationClasses; ++elevation) {
      Lags& own = lags_[kind][elevation];
      Lags sum = own;
      for (std::size_t i = 0; i < kLags; ++i) {
        if (all[i].count > 0.0) add_weighted(all[i], kObservablePairs / all[i].count, &sum[i]);
        own[i].count *= keep;
        own[i].product *= keep;
        own[i].lag_s *= keep;
      }
      models_[kind][elevation] = fit(sum);
    }
  }
}

}  // namespace leonav
