#include "core/navigator/monitors/measurement_rejection_monitor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/median.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"

namespace leonav {
namespace {

constexpr double kRequiredEvidence_s = 30.0;   // epochs against the filter, in sum
constexpr double kLongestEvidence_s = 10.0;    // so that a verdict needs three epochs at least
constexpr double kMaxCodeMultipath_m = 100.0;  // largest error that reflections may cause
constexpr double kMaxSignalDetour_m = 300.0;
constexpr double kClockShare = 10.0;  // common innovation of the codes over their discrepancy
constexpr int kMinCodes = 2;
constexpr int kMinConfirming = 2;  // carriers
constexpr int kMinRedundancy = 2;  // from which on a point solution can check the filter

using Innovations = boost::container::static_vector<double, kMaxMeasurements>;

struct Kind {
  Innovations innovations;
  int rejected = 0;
  int offered() const { return static_cast<int>(innovations.size()); }
  bool most_rejected() const { return 2 * rejected > offered(); }
};

// Returns the second largest deviation of the innovations from their median, of two the largest.
double second_largest_deviation(const Kind& kind) {
  if (kind.offered() < kMinCodes) return 0.0;
  const double shared = median(kind.innovations);
  Innovations left;
  for (const double innovation : kind.innovations) left.push_back(std::abs(innovation - shared));
  std::sort(left.begin(), left.end());
  return left[left.size() > 2 ? left.size() - 2 : left.size() - 1];
}

}  // namespace

RejectionVerdict MeasurementRejectionMonitor::add(const EkfUpdateResult& result,
                                                  const MeasurementEpoch& epoch, GpsTime time) {
  const double passed_s = last_.is_set() ? seconds_between(time, last_) : 0.0;
  last_ = time;
  const double interval_s = std::clamp(passed_s, 0.0, kLongestEvidence_s);
  Kind codes, dopplers, held;
  std::array<bool, kMaxSystemTimes> systems{};
  for (std::size_t i = 0; i < std::min(result.innovations.size(), epoch.measurements.size()); ++i) {
    const InnovationReport& report = result.innovations[i];
    const Measurement& measurement = epoch.measurements[i];
    if (!(report.innovation_variance > 0.0)) continue;
    const bool carrier = measurement.observable == Observable::kCarrier;
    if (carrier && report.innovation_variance >= kUnknownAmbiguityVariance) continue;
    Kind& kind = carrier ? held : measurement.observable == Observable::kCode ? codes : dopplers;
    kind.innovations.push_back(report.innovation);
    kind.rejected += report.weight_factor > 0.0 ? 0 : 1;
    if (&kind == &codes)
      systems[index_of(epoch.satellites[measurement.satellite_index].satellite.system)] = true;
  }
  const int unknowns = 3 + static_cast<int>(std::count(systems.begin(), systems.end(), true));
  if (codes.offered() < kMinCodes || codes.offered() - unknowns >= kMinRedundancy)
    return RejectionVerdict::kNone;
  if (!codes.most_rejected()) {
    position_evidence_s_ = std::max(0.0, position_evidence_s_ - interval_s);
    clock_evidence_s_ = std::max(0.0, clock_evidence_s_ - interval_s);
    return RejectionVerdict::kNone;
  }
  enough_to_start_ = codes.offered() >= unknowns;
  code_discrepancy_m_ = second_largest_deviation(codes);
  doppler_discrepancy_m_s_ = second_largest_deviation(dopplers);
  const double shared_m = std::abs(median(codes.innovations));
  const bool confirmed = held.offered() >= kMinConfirming && !held.most_rejected();
  const bool moves_otherwise =
      dopplers.offered() > 0 ? dopplers.most_rejected() : code_discrepancy_m_ > kMaxCodeMultipath_m;
  if (shared_m > kMaxCodeMultipath_m && shared_m > kClockShare * code_discrepancy_m_)
    clock_evidence_s_ += interval_s;
  else if (code_discrepancy_m_ > kMaxSignalDetour_m || (moves_otherwise && !confirmed))
    position_evidence_s_ += interval_s;
  const RejectionVerdict found =
      position_evidence_s_ >= kRequiredEvidence_s ? RejectionVerdict::kPosition
      : clock_evidence_s_ >= kRequiredEvidence_s  ? RejectionVerdict::kClocks
                                                  : RejectionVerdict::kNone;
  if (found != RejectionVerdict::kNone) reset();
  return found;
}

}  // namespace leonav
