// These functions find steps of the receiver clocks in innovations: codes against carriers, and one
// system against the others.
#pragma once
#include <optional>

#include "core/filter/update/robust_update.h"
#include "core/gnss/measurement/measurement.h"
#include "core/robust/common_step.h"

namespace leonav {

inline constexpr int kAllSystems = -1;

// Returns whether `system` is `wanted`, or all systems are.
inline bool is_of(int system, int wanted) { return wanted == kAllSystems || system == wanted; }

// Returns the system of a measurement's satellite, as an index of System.
int system_of(const FilterMeasurement& measurement, const MeasurementEpoch& epoch);

// Returns the step of a system's codes (or of all codes) against their carriers, m. The difference
// of code and carrier innovation is free of position and clock; satellites whose carriers have a
// known ambiguity count. nullopt: no step, or too few satellites.
std::optional<CommonStep> code_step(const FilterMeasurements& measurements,
                                    const MeasurementEpoch& epoch, int system,
                                    const EkfCovariance& covariance);

// Returns the median over the satellites of what code_step() examines, m; nullopt if no satellite
// has both.
std::optional<double> median_code_minus_carrier(const FilterMeasurements& measurements,
                                                const MeasurementEpoch& epoch,
                                                const EkfCovariance& covariance);

// Returns the system with codes of the most satellites (the first one of several), the reference of
// inter_system_step().
int largest_system(const FilterMeasurements& measurements, const MeasurementEpoch& epoch);

// A step of one system's time against the `reference` system's, from the codes of both: their
// innovations minus the median of the reference's. Carriers may have made it or not.
struct InterSystemStep {
  double predicted_sigma_m = 0.0;  // of the step, by the prediction alone; 0: too few codes
  std::optional<CommonStep> step;
};
InterSystemStep inter_system_step(const FilterMeasurements& measurements,
                                  const MeasurementEpoch& epoch, int system, int reference,
                                  const EkfCovariance& covariance);

// Returns the same where the predicted position is too uncertain: from a fit to all codes in which
// this system's clock is unknown.
std::optional<CommonStep> fitted_inter_system_step(const RobustConfig& robust,
                                                   const FilterMeasurements& measurements,
                                                   const MeasurementEpoch& epoch, int system,
                                                   int reference, const EkfCovariance& covariance,
                                                   RobustUpdate* robust_update);

}  // namespace leonav
