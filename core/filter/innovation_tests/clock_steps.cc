#include "core/filter/innovation_tests/clock_steps.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/median.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"

namespace leonav {
namespace {

using namespace ekf_index;
constexpr double kFreeClock_m2 = 1e12;  // of a clock that may be anywhere
using Samples = boost::container::static_vector<StepSample, kMaxSatellites>;

// The first code of each satellite: those of its other bands share its errors.
using Codes = std::array<const FilterMeasurement*, kMaxSatellites>;

Codes codes_of(const FilterMeasurements& measurements, const MeasurementEpoch& epoch, int system) {
  Codes codes{};
  for (const FilterMeasurement& m : measurements) {
    if (m.observable != Observable::kCode) continue;
    if (!is_of(system_of(m, epoch), system)) continue;
    const FilterMeasurement*& code = codes[epoch.measurements[m.index].satellite_index];
    if (code == nullptr) code = &m;
  }
  return codes;
}

struct Differences {
  Samples samples;
  boost::container::static_vector<Eigen::Index, kMaxSatellites> ambiguities;  // states
  double ionosphere_mapping = 0.0;                                            // of the codes, sum
};

Differences code_less_carrier(const FilterMeasurements& measurements, const MeasurementEpoch& epoch,
                              int system, const EkfCovariance& P) {
  const Codes codes = codes_of(measurements, epoch, system);
  Differences found;
  for (const FilterMeasurement& carrier : measurements) {
    if (carrier.ambiguity < 0 ||
        P(carrier.ambiguity, carrier.ambiguity) >= kUnknownAmbiguityVariance)
      continue;
    const FilterMeasurement* code = codes[epoch.measurements[carrier.index].satellite_index];
    if (code == nullptr || found.samples.size() == found.samples.capacity()) continue;
    found.samples.push_back(
        {code->innovation - carrier.innovation, std::sqrt(code->variance + carrier.variance)});
    found.ambiguities.push_back(carrier.ambiguity);
    found.ionosphere_mapping += code->row(kIonosphere);
  }
  return found;
}

// Sigma of the mean ambiguity, with the carriers' clock against the codes' and the codes' delay in
// the ionosphere: what all share.
double sigma_of_ambiguities(const Differences& differences, const EkfCovariance& P) {
  const double share = 1.0 / static_cast<double>(differences.ambiguities.size());
  const double m = share * differences.ionosphere_mapping;
  double variance = P(kCarrierClock, kCarrierClock) + m * m * P(kIonosphere, kIonosphere) -
                    2.0 * m * P(kIonosphere, kCarrierClock);
  for (const Eigen::Index a : differences.ambiguities) {
    variance += 2.0 * share * (P(a, kCarrierClock) - m * P(a, kIonosphere));
    for (const Eigen::Index b : differences.ambiguities) variance += share * share * P(a, b);
  }
  return std::sqrt(std::max(variance, 0.0));
}

}  // namespace

int system_of(const FilterMeasurement& measurement, const MeasurementEpoch& epoch) {
  const std::size_t satellite = epoch.measurements[measurement.index].satellite_index;
  return static_cast<int>(index_of(epoch.satellites[satellite].satellite.system));
}

std::optional<CommonStep> code_step(const FilterMeasurements& measurements,
                                    const MeasurementEpoch& epoch, int system,
                                    const EkfCovariance& covariance) {
  const Differences found = code_less_carrier(measurements, epoch, system, covariance);
  if (found.samples.size() < kMinStepSamples) return std::nullopt;
  return find_common_step({found.samples.data(), found.samples.size()},
                          sigma_of_ambiguities(found, covariance));
}

std::optional<double> median_code_minus_carrier(const FilterMeasurements& measurements,
                                                const MeasurementEpoch& epoch,
                                                const EkfCovariance& covariance) {
  const Differences found = code_less_carrier(measurements, epoch, kAllSystems, covariance);
  if (found.samples.empty()) return std::nullopt;
  boost::container::static_vector<double, kMaxSatellites> values;
  for (const StepSample& sample : found.samples) values.push_back(sample.value_m);
  return median(values);
}

int largest_system(const FilterMeasurements& measurements, const MeasurementEpoch& epoch) {
  std::array<int, kMaxSystemTimes> counts{};
  for (const FilterMeasurement* code : codes_of(measurements, epoch, kAllSystems))
    if (code != nullptr) ++counts[static_cast<std::size_t>(system_of(*code, epoch))];
  return static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

InterSystemStep inter_system_step(const FilterMeasurements& measurements,
                                  const MeasurementEpoch& epoch, int system, int reference,
                                  const EkfCovariance& covariance) {
  InterSystemStep found;
  boost::container::static_vector<double, kMaxSatellites> of_reference;
  EkfVector row = EkfVector::Zero();
  double reference_variance = 0.0;
  const Codes reference_codes = codes_of(measurements, epoch, reference);
  for (const FilterMeasurement* code : reference_codes) {
    if (code == nullptr) continue;
    of_reference.push_back(code->innovation);
    reference_variance += code->variance;
    row -= code->row;
  }
  if (of_reference.size() < kMinStepSamples) return found;
  const auto count = static_cast<double>(of_reference.size());
  row /= count;
  const double middle = median(of_reference);
  Samples samples;
  EkfVector sum = EkfVector::Zero();
  const Codes system_codes = codes_of(measurements, epoch, system);
  for (const FilterMeasurement* code : system_codes) {
    if (code == nullptr) continue;
    samples.push_back({code->innovation - middle, std::sqrt(code->variance)});
    sum += code->row;
  }
  if (samples.size() < kMinStepSamples) return found;
  row += sum / static_cast<double>(samples.size());
  const double predicted = std::max(row.dot(covariance.topLeftCorner<kSize, kSize>() * row), 0.0);
  found.predicted_sigma_m = std::sqrt(predicted);
  // The reference's median has pi / 2 times the variance of its mean.
  const double common = predicted + kMedianVariance * reference_variance / (count * count);
  found.step = find_common_step({samples.data(), samples.size()}, std::sqrt(common));
  return found;
}

std::optional<CommonStep> fitted_inter_system_step(const RobustConfig& robust,
                                                   const FilterMeasurements& measurements,
                                                   const MeasurementEpoch& epoch, int system,
                                                   int reference, const EkfCovariance& covariance,
                                                   RobustUpdate* robust_update) {
  FilterMeasurements codes;
  for (const FilterMeasurement* code : codes_of(measurements, epoch, kAllSystems))
    if (code != nullptr) codes.push_back(*code);
  const int clock = kClock + system, other = kClock + reference;
  const auto variance_apart = [&](const EkfCovariance& P) {
    return P(clock, clock) + P(other, other) - 2.0 * P(clock, other);
  };
  EkfCovariance vague = covariance;
  vague.row(clock).setZero();
  vague.col(clock).setZero();
  vague(clock, clock) = kFreeClock_m2;
  const RobustUpdateResult fit = (*robust_update)(robust, &codes, &vague);
  CommonStep step;
  step.value_m = fit.correction(clock) - fit.correction(other);
  // By how far the fit's residuals are larger than their sigmas, it is worse itself.
  const double scale = fit.scale[static_cast<std::size_t>(Observable::kCode)];
  step.sigma_m = std::sqrt(variance_apart(covariance) + scale * scale * variance_apart(vague));
  if (!(std::abs(step.value_m) > kStepSignificance * step.sigma_m)) return std::nullopt;
  return step;
}

}  // namespace leonav
