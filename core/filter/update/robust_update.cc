#include "core/filter/update/robust_update.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/median.h"

namespace leonav {
namespace {

using SmallTable = WeightedLeastSquares::Ratios;

constexpr double kFactorTolerance = 1e-3;   // weights that change less have converged
constexpr double kUnconvergedChange = 0.5;  // ... and more than this have not
constexpr int kMaxRounds = 20;              // of throwing out the worst
constexpr double kNearWorst = 0.7;          // of the worst: go with it
constexpr double kNormalMedian = 0.6745;    // median of |x| for a standard normal x
constexpr double kMaxPriorScale = 2.0;  // innovations may be this much larger than they should be
constexpr double kUnlimited = std::numeric_limits<double>::infinity();
// Residuals that are this much larger, the worst of them left out, are of measurements that
// contradict each other.
constexpr double kMaxScale = 3.0;
constexpr std::size_t kMinScaleCount = 5;  // fewer residuals do not show their scale

double scale_of(const FilterMeasurements& measurements, const SmallTable& ratios,
                Observable observable) {
  SmallTable of_kind;
  for (std::size_t i = 0; i < measurements.size(); ++i)
    if (measurements[i].observable == observable) of_kind.push_back(ratios[i]);
  if (of_kind.size() < kMinScaleCount) return 1.0;
  return std::max(1.0, median(of_kind) / kNormalMedian);
}

bool is_inflated(const FilterMeasurement& measurement, double scale_of_kind) {
  return measurement.observable != Observable::kCarrier && scale_of_kind > kMaxScale;
}

// Measurements that contradict each other get the variance that their residuals show. Carriers do
// not: those have slipped. False if there are none.
bool inflate_contradicting_sigmas(const std::array<double, kObservables>& scale,
                                  FilterMeasurements* measurements) {
  bool any = false;
  for (FilterMeasurement& measurement : *measurements) {
    const double of_kind = scale[static_cast<std::size_t>(measurement.observable)];
    if (!is_inflated(measurement, of_kind)) continue;
    measurement.variance *= of_kind * of_kind;
    measurement.gain_variance *= of_kind * of_kind;
    any = true;
  }
  return any;
}

// Undoes inflate_contradicting_sigmas(): factor / variance, what a measurement weighs, stays as it
// is.
void undo_sigma_inflation(const std::array<double, kObservables>& scale,
                          FilterMeasurements* measurements) {
  for (FilterMeasurement& measurement : *measurements) {
    const double of_kind = scale[static_cast<std::size_t>(measurement.observable)];
    if (!is_inflated(measurement, of_kind)) continue;
    measurement.factor /= of_kind * of_kind;
    measurement.variance /= of_kind * of_kind;
    measurement.gain_variance /= of_kind * of_kind;
  }
}

// Where ranges contradict each other a few carriers that happen to agree, as four always do about
// one position, must not decide by their millimetres: without most of them on their side none
// counts. Returns whether that is so.
template <typename Limits>
bool exclude_few_carriers(const FilterMeasurements& measurements, Limits* limits) {
  std::size_t offered = 0, kept = 0;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != Observable::kCarrier) continue;
    ++offered;
    kept += measurement.factor > 0.0 ? 1 : 0;
  }
  if (4 * kept >= 3 * offered) return false;
  for (std::size_t i = 0; i < limits->size(); ++i)
    if (measurements[i].observable == Observable::kCarrier) (*limits)[i] = 0.0;
  return true;
}

// By how much an observable's residuals are taken to be larger than they should be, at most
// `most`. Carriers that fit no better than kMaxPriorScale have slipped, however many they are.
double scale_for(const FilterMeasurement& measurement, const RobustUpdateResult& weighed,
                 double most) {
  const double limit = measurement.observable == Observable::kCarrier ? kMaxPriorScale : most;
  return std::min(limit, weighed.scale[static_cast<std::size_t>(measurement.observable)]);
}

// Returns the largest change of a factor. `limits` are the factors that the prior allows: what it
// excludes, no number of others can bring back.
double reweight(const RobustConfig& config, const SmallTable& ratios, double max_scale,
                const SmallTable& limits, FilterMeasurements* measurements,
                RobustUpdateResult* result) {
  for (std::size_t kind = 0; kind < kObservables; ++kind)
    result->scale[kind] = scale_of(*measurements, ratios, static_cast<Observable>(kind));
  double change = 0.0;
  for (std::size_t i = 0; i < measurements->size(); ++i) {
    FilterMeasurement& measurement = (*measurements)[i];
    const double ratio = ratios[i] / scale_for(measurement, *result, max_scale);
    const double factor = std::min(limits[i], igg3_factor(ratio, config.k0, config.k1));
    change = std::max(change, std::abs(factor - measurement.factor));
    measurement.factor = factor;
  }
  return change;
}

// Carriers that have come in or gone out in both of the last two passes. Two carriers, each of
// which agrees with the prediction where the other is left out, do so for ever, however little they
// weigh.
class AlternatingCarriers {
 public:
  explicit AlternatingCarriers(const FilterMeasurements& measurements)
      : carriers_(measurements.size()) {}

  // Adds the factors after a pass.
  void add(const FilterMeasurements& measurements) {
    any_ = false;
    for (std::size_t i = 0; i < carriers_.size(); ++i) {
      Carrier& carrier = carriers_[i];
      if (measurements[i].observable != Observable::kCarrier) continue;
      const bool used = measurements[i].factor > 0.0, changed = used != carrier.used;
      any_ = any_ || (changed && carrier.changed);
      carrier = {used, changed};
    }
  }
  bool any() const { return any_; }

 private:
  struct Carrier {
    bool used = false, changed = false;
  };
  boost::container::static_vector<Carrier, kMaxMeasurements> carriers_;
  bool any_ = false;
};

}  // namespace

// Iterates the weights; least_squares_ then holds the solution. `limits`: what the prior excludes,
// 0; that of an earlier call stays out.
void RobustUpdate::weigh(const RobustConfig& config, FactorLimits* limits, bool* worst_excluded,
                         FilterMeasurements* measurements, RobustUpdateResult* result) {
  for (FilterMeasurement& measurement : *measurements) measurement.factor = 0.0;
  least_squares_.solve(*measurements);
  SmallTable ratios;
  double change = 1.0;
  AlternatingCarriers alternating(*measurements);
  for (int pass = 0; pass < std::max(config.max_iterations, 1); ++pass) {
    const bool first = pass == 0;  // nothing used yet: innovations
    least_squares_.standardize(*measurements, &ratios);
    for (std::size_t i = 0; first && i < ratios.size(); ++i)
      ratios[i] = std::max(ratios[i], (*measurements)[i].prior_ratio);
    change = reweight(config, ratios, first ? kMaxPriorScale : kUnlimited, *limits, measurements,
                      result);
    if (first) {
      for (std::size_t i = 0; i < limits->size(); ++i)
        (*limits)[i] = (*measurements)[i].factor > 0.0 ? 1.0 : 0.0;
    }
    alternating.add(*measurements);
    least_squares_.solve(*measurements);
    if (change < kFactorTolerance) return;
  }
  const bool converges = change < kUnconvergedChange && !alternating.any();
  if (converges || config.max_iterations < 3 || *worst_excluded) return;
  exclude_worst_first(config, *result, limits, measurements);
  *worst_excluded = true;
  weigh(config, limits, worst_excluded, measurements, result);
}

// Where many carriers contradict each other they go out together, fit the codes, come in together,
// and so on. Then the worst go one after the other, from all that the prior allows, until the rest
// agree; and carriers that only a few are left of prove nothing.
void RobustUpdate::exclude_worst_first(const RobustConfig& config,
                                       const RobustUpdateResult& weighed, FactorLimits* limits,
                                       FilterMeasurements* measurements) {
  SmallTable ratios;
  for (std::size_t i = 0; i < limits->size(); ++i)
    if ((*measurements)[i].observable == Observable::kCarrier)
      (*measurements)[i].factor = (*limits)[i];
  for (int round = 0; round < kMaxRounds; ++round) {
    least_squares_.solve(*measurements);
    least_squares_.standardize(*measurements, &ratios);
    double worst = 0.0;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      FilterMeasurement& measurement = (*measurements)[i];
      ratios[i] /= scale_for(measurement, weighed, kUnlimited);
      if (measurement.observable != Observable::kCarrier)
        measurement.factor = std::min((*limits)[i], igg3_factor(ratios[i], config.k0, config.k1));
      else if (measurement.factor > 0.0)
        worst = std::max(worst, ratios[i]);
    }
    if (worst < config.k1) break;
    for (std::size_t i = 0; i < ratios.size(); ++i)
      if ((*measurements)[i].observable == Observable::kCarrier && ratios[i] >= kNearWorst * worst)
        (*limits)[i] = (*measurements)[i].factor = 0.0;
  }
  exclude_few_carriers(*measurements, limits);
}

// Weighs; where measurements contradict each other, once more with the variance they then have.
// Without carriers that had outvoted them, others may be found to contradict each other.
void RobustUpdate::weigh_with_inflated_sigmas(const RobustConfig& config, FactorLimits* limits,
                                              FilterMeasurements* measurements,
                                              RobustUpdateResult* result) {
  bool worst_excluded = false;
  weigh(config, limits, &worst_excluded, measurements, result);
  auto scale = result->scale;
  if (!inflate_contradicting_sigmas(scale, measurements)) return;
  worst_excluded = false;
  weigh(config, limits, &worst_excluded, measurements, result);
  if (exclude_few_carriers(*measurements, limits)) {
    weigh(config, limits, &worst_excluded, measurements, result);
    auto more = result->scale;
    for (std::size_t kind = 0; kind < kObservables; ++kind) {
      const bool found = scale[kind] <= kMaxScale && more[kind] > kMaxScale;
      (found ? scale[kind] : more[kind]) = found ? more[kind] : 1.0;
    }
    if (inflate_contradicting_sigmas(more, measurements))
      weigh(config, limits, &worst_excluded, measurements, result);
  }
  result->scale = scale;
}

RobustUpdateResult RobustUpdate::operator()(const RobustConfig& config,
                                            FilterMeasurements* measurements,
                                            EkfCovariance* covariance) {
  RobustUpdateResult result;
  result.correction.setZero(covariance->rows());
  if (measurements->empty()) return result;
  least_squares_.begin(*measurements, *covariance);
  if (config.enabled) {
    FactorLimits limits(measurements->size(), 1.0);
    weigh_with_inflated_sigmas(config, &limits, measurements, &result);
  } else {
    for (FilterMeasurement& measurement : *measurements) measurement.factor = 1.0;
    least_squares_.solve(*measurements);
  }
  result.nis = least_squares_.nis(*measurements);
  least_squares_.finish(&result.correction, covariance);
  undo_sigma_inflation(result.scale, measurements);
  for (const FilterMeasurement& measurement : *measurements) {
    const auto kind = static_cast<std::size_t>(measurement.observable);
    if (is_inflated(measurement, result.scale[kind]))
      result.sigma_inflation[kind] = result.scale[kind];
  }
  return result;
}

}  // namespace leonav
