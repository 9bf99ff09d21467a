#include "core/filter/innovation_tests/clock_removed_innovations.h"

#include <algorithm>
#include <array>

#include "core/base/median.h"

namespace leonav {
namespace {

using namespace ekf_index;

// Fewer are mostly what their own median is, and show nothing.
constexpr std::size_t kMinOfSystem = 4;

// H_a P H_b^T of two measurements.
double predicted_covariance(const FilterMeasurement& a, const FilterMeasurement& b,
                            const EkfCovariance& P) {
  double covariance = a.row.dot(P.topLeftCorner<kSize, kSize>() * b.row);
  if (a.signal_state >= 0) covariance += P.col(a.signal_state).head<kSize>().dot(b.row);
  if (b.signal_state >= 0) covariance += P.col(b.signal_state).head<kSize>().dot(a.row);
  if (a.signal_state >= 0 && b.signal_state >= 0) covariance += P(a.signal_state, b.signal_state);
  return covariance;
}

// Less the median, and its row less the mean row.
void take_out_median(const FilterMeasurements& measurements, const EkfCovariance& covariance,
                     ClockRemovedInnovations* table) {
  boost::container::static_vector<double, kMaxMeasurements> innovations;
  EkfVector shared = EkfVector::Zero();
  for (const ClockRemovedInnovation& entry : *table) {
    innovations.push_back(entry.innovation);
    shared += measurements[entry.index].row / static_cast<double>(table->size());
  }
  const double middle = median(innovations);
  for (ClockRemovedInnovation& entry : *table) {
    FilterMeasurement relative = measurements[entry.index];
    relative.row.segment<8>(kClock) -= shared.segment<8>(kClock);
    entry.innovation -= middle;
    entry.variance = relative.variance + std::max(predicted_variance(relative, covariance), 0.0);
  }
}

// Less the one in the middle: their ambiguities too have much in common.
void take_out_middle_one(const FilterMeasurements& measurements, const EkfCovariance& covariance,
                         ClockRemovedInnovations* table) {
  ClockRemovedInnovations sorted = *table;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end(),
                   [](const ClockRemovedInnovation& a, const ClockRemovedInnovation& b) {
                     return a.innovation != b.innovation ? a.innovation < b.innovation
                                                         : a.index < b.index;
                   });
  const FilterMeasurement& reference = measurements[middle->index];
  const double of_reference = predicted_covariance(reference, reference, covariance);
  for (ClockRemovedInnovation& entry : *table) {
    const FilterMeasurement& m = measurements[entry.index];
    entry.innovation -= reference.innovation;
    entry.variance = m.variance + reference.variance +
                     std::max(predicted_covariance(m, m, covariance) + of_reference -
                                  2.0 * predicted_covariance(m, reference, covariance),
                              0.0);
  }
}

std::size_t system_of(const FilterMeasurement& measurement) {
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    const auto i = static_cast<Eigen::Index>(system);
    if (measurement.row(kClock + i) != 0.0 || measurement.row(kClockDrift + i) != 0.0)
      return system;
  }
  return 0;
}

// The entries of systems that have few go to the one that has most.
void join_small(std::array<ClockRemovedInnovations, kMaxSystemTimes>* of_system) {
  const auto largest =
      std::max_element(of_system->begin(), of_system->end(),
                       [](const ClockRemovedInnovations& a, const ClockRemovedInnovations& b) {
                         return a.size() < b.size();
                       });
  for (ClockRemovedInnovations& entries : *of_system) {
    if (&entries == &*largest || entries.size() >= kMinOfSystem) continue;
    largest->insert(largest->end(), entries.begin(), entries.end());
    entries.clear();
  }
}

}  // namespace

ClockRemovedInnovations clock_removed_innovations(const FilterMeasurements& measurements,
                                                  Observable observable,
                                                  const EkfCovariance& covariance) {
  std::array<ClockRemovedInnovations, kMaxSystemTimes> of_system;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& m = measurements[i];
    if (m.observable != observable) continue;
    if (observable == Observable::kCarrier &&
        covariance(m.signal_state, m.signal_state) >= kUnknownAmbiguityVariance)
      continue;
    of_system[system_of(m)].push_back({i, m.innovation, 0.0, error_variance(m, covariance)});
  }
  join_small(&of_system);
  ClockRemovedInnovations table;
  for (ClockRemovedInnovations& entries : of_system) {
    if (entries.empty()) continue;
    if (observable == Observable::kCarrier)
      take_out_middle_one(measurements, covariance, &entries);
    else
      take_out_median(measurements, covariance, &entries);
    table.insert(table.end(), entries.begin(), entries.end());
  }
  return table;
}

}  // namespace leonav
