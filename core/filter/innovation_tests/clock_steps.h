// Steps of the clocks that the filter's prediction does not know of, told by what position and
// clocks' noise cannot explain: codes against carriers, and one time base against the others.
#pragma once
#include <optional>

#include "core/filter/update/robust_update.h"
#include "core/gnss/measurement/measurement.h"
#include "core/robust/common_step.h"

namespace leonav {

inline constexpr int kAllBases = -1;

int base_of(const FilterMeasurement& measurement, const MeasurementEpoch& epoch);

// The step of a base's codes (or of all codes) against their carriers, from the satellites whose
// carriers have a known ambiguity: the difference of the two innovations is free of position and
// clock. nullopt: none, or too few to tell.
std::optional<CommonStep> code_step(const FilterMeasurements& measurements,
                                    const MeasurementEpoch& epoch, int base,
                                    const EkfCovariance& covariance);

// What code_step() would look at, whatever it is: median over the satellites, m. nullopt: no
// satellite with both.
std::optional<double> median_code_minus_carrier(const FilterMeasurements& measurements,
                                                const MeasurementEpoch& epoch,
                                                const EkfCovariance& covariance);

// Base whose codes are most satellites' (ties: the first one), the reference of
// inter_system_step().
int largest_base(const FilterMeasurements& measurements, const MeasurementEpoch& epoch);

// The step of a base's time against the `reference` base's, from the codes of both: what is left of
// their innovations without the median of the reference's. Carriers may have made it or not.
struct InterSystemStep {
  double predicted_sigma_m = 0.0;  // of it, by the prediction alone; 0: not asked, codes too few
  std::optional<CommonStep> step;
};
InterSystemStep inter_system_step(const FilterMeasurements& measurements,
                                  const MeasurementEpoch& epoch, int base, int reference,
                                  const EkfCovariance& covariance);

// The same where the predicted position is too vague for it: from a fit to all codes in which the
// base's clock is free of the others'.
std::optional<CommonStep> fitted_inter_system_step(const RobustConfig& robust,
                                                   const FilterMeasurements& measurements,
                                                   const MeasurementEpoch& epoch, int base,
                                                   int reference, const EkfCovariance& covariance,
                                                   RobustUpdate* robust_update);

}  // namespace leonav
