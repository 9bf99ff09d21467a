#include "core/navigator/monitors/satellite_fault_hypotheses.h"

#include <algorithm>
#include <array>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/filter/state/ambiguities.h"
#include "core/filter/update/fault_directions.h"
#include "core/integrity/risk.h"

namespace leonav {
namespace {

// A separation within so many of its own sigmas may be chance.
constexpr double kChance = 3.0;
constexpr double kRare = 0.005;  // probability

// Returns the change of a carrier by a slip that its tests may miss, m; 0: the signal is not known.
double missed_slip_m(const BandPlan& bands, System system, const Measurement& carrier) {
  const double first_hz = bands.frequency_hz(system, carrier.code.band);
  if (!(first_hz > 0.0)) return 0.0;
  const bool pair = carrier.second_code != SignalCode();
  return kSpeedOfLight /
         (first_hz + (pair ? bands.frequency_hz(system, carrier.second_code.band) : 0.0));
}

// Whether |separation| and kChance of its sigmas are within one sigma of the filter, per axis.
bool is_small(const FaultHypothesis& fault, const Eigen::Matrix3d& covariance_n) {
  const Eigen::Array3d reach =
      fault.separation_n.array().abs() +
      kChance * fault.separation_covariance_n.diagonal().array().max(0.0).sqrt();
  return (reach < covariance_n.diagonal().array().sqrt()).all();
}

}  // namespace

FaultHypotheses satellite_fault_hypotheses(const SatelliteFaultMonitor& monitor,
                                           const MeasurementEpoch& epoch,
                                           const FilterMeasurements& measurements,
                                           const Ambiguities& ambiguities,
                                           const PositionEstimate& estimate,
                                           const IntegrityConfig& config, const BandPlan& bands) {
  FaultHypotheses faults;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(estimate.p_e));
  const Eigen::Matrix3d covariance_n = C_ne * estimate.covariance_e * C_ne.transpose();
  const auto probability = [&config](double rate_per_hour) {
    return fault_probability(rate_per_hour, config.fault_exposure_s, config.error_correlation_s);
  };
  const auto add = [&](const FaultHypothesis& fault) {
    const bool counts = fault.probability > kRare || !is_small(fault, covariance_n);
    if (fault.probability > 0.0 && counts && faults.size() < faults.capacity())
      faults.push_back(fault);
  };
  std::array<FaultHypothesis, kSystemCount> systems{};
  for (const System system : kSystems)
    systems[index_of(system)].probability = probability(
        system == System::kLeo ? config.leo_faults_per_hour : config.system_faults_per_hour);
  const FaultDirections directions(measurements);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& m = measurements[i];
    if (m.observable != Observable::kCarrier || m.ambiguity < 0) continue;
    const Measurement& measurement = epoch.measurements[m.index];
    const SatelliteId satellite = epoch.satellites[measurement.satellite_index].satellite;
    const Eigen::Vector3d per_metre_n = C_ne * directions.position_e(i);
    FaultHypothesis slip;
    slip.probability = probability(config.missed_slips_per_hour);
    double slip_m = missed_slip_m(bands, satellite.system, measurement);
    // A wrong join is as a slip that was missed, and by the larger of the two lengths.
    const int ambiguity = find_ambiguity(ambiguities, measurement.arc);
    if (ambiguity != kNoAmbiguity && slip.probability > 0.0) {
      const Ambiguity& joined = ambiguities[static_cast<std::size_t>(ambiguity)];
      slip.probability = std::min(1.0, slip.probability + joined.wrong_join_probability);
      slip_m = std::max(slip_m, joined.wrong_join_m);
    }
    slip.separation_n = slip_m * per_metre_n;
    add(slip);
    const auto followed = monitor.followed_range(satellite, measurement.code);
    if (!followed) continue;
    FaultHypothesis fault;
    fault.probability =
        probability(satellite.system == System::kLeo ? config.leo_faults_per_hour
                                                     : config.satellite_faults_per_hour);
    fault.separation_n = followed->range_m * per_metre_n;
    fault.separation_covariance_n =
        square(followed->usual_m) * per_metre_n * per_metre_n.transpose();
    add(fault);
    FaultHypothesis& system = systems[index_of(satellite.system)];
    system.separation_n += fault.separation_n;
    system.separation_covariance_n += fault.separation_covariance_n;
  }
  for (const FaultHypothesis& system : systems) add(system);
  return faults;
}

}  // namespace leonav
