// CodeVarianceModel gives the variance with which a code enters the gain, given that code errors
// are correlated in time.
#pragma once
#include <optional>

#include "core/base/gps_time.h"
#include "core/filter/state/ekf_config.h"
#include "core/filter/update/colored_code_weighting.h"
#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// While carriers keep the position from epoch to epoch, the codes of a satellite are weighed
// jointly (core/filter/update/colored_code_weighting.h). Otherwise each is inflated by
// variance_inflation() of its errors' correlation. Carriers do not keep the position where many
// arcs end (a phone, a receiver among trees): then the codes hold it, and it follows their errors.
class CodeVarianceModel {
 public:
  explicit CodeVarianceModel(const EkfConfig& config) : is_static_(config.static_point) {}

  void reset();
  // Forgets the codes used so far.
  void forget_codes() { weighting_.clear(); }
  // Enters the codes that the last update has used.
  void accept(const FilterMeasurements& measurements);
  // Judges from the arcs whether carriers keep the position since `last_update`.
  void begin_epoch(const MeasurementEpoch& epoch, const SignalStates& ambiguities,
                   GpsTime last_update);
  // Sets gain_variance, and code_weighting_entry for accept(), of `entry` from its variance.
  // Returns the part of gain_variance by which errors that last (orbit, clock, modelled ionosphere)
  // exceed the inflated noise, m^2; nothing where the code counts in full with its whole variance.
  // `inflation`: variance_inflation() of its noise. `correlation_time_ratio`: of this satellite's
  // correlation times to those of one in medium orbit.
  std::optional<double> weigh(const MeasurementEpoch& epoch, const Measurement& code,
                              double inflation, double correlation_time_ratio,
                              FilterMeasurement* entry);

 private:
  // kNewArcs: whether the arcs last is not known yet.
  enum class CarrierContinuity { kNone, kNewArcs, kContinuous };
  CarrierContinuity evaluate_carrier_continuity(const MeasurementEpoch& epoch,
                                                const SignalStates& ambiguities,
                                                GpsTime last_update);

  bool is_static_;
  ColoredCodeWeighting weighting_;
  CarrierContinuity continuity_ = CarrierContinuity::kNone;
  GpsTime new_arcs_until_;             // no arc went on from before
  GpsTime frequent_arc_breaks_until_;  // too many arcs ended
};

}  // namespace leonav
