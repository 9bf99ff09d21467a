// CodeVarianceModel gives the variance with which a code enters the gain, given that code errors
// are correlated in time.
#pragma once
#include "core/base/gps_time.h"
#include "core/filter/state/ekf_config.h"
#include "core/filter/update/colored_code_weighting.h"
#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// While carriers keep the position from epoch to epoch, the codes of a satellite are weighed
// jointly (core/filter/update/colored_code_weighting.h). Otherwise each is inflated by
// variance_inflation() of its errors' correlation. Carriers do not keep the position where many
// arcs end (a phone, a receiver among trees), or none goes on: then the codes hold it, and it
// follows their errors. What lasts longer than noise and reflections (orbit, clock, ionosphere) is
// then inflated for a twentieth of the position's memory, at most 20 s: an inertial sensor that
// keeps the position for minutes would otherwise average errors that stay the same.
class CodeVarianceModel {
 public:
  explicit CodeVarianceModel(const EkfConfig& config) : is_static_(config.static_point) {}

  void reset();
  // Forgets the codes used so far.
  void forget_codes() { weighting_.clear(); }
  // Enters the codes that the last update has used.
  void accept(const FilterMeasurements& measurements);
  // Enters an update, `interval_s` after the one before, that changed the variance of the position
  // from `before` to `after`, m^2. The memory is the interval over the mean gain 1 - after /
  // before.
  void add_update(double before, double after, double interval_s);
  // Judges from the arcs whether carriers keep the position since `last_update`.
  void begin_epoch(const MeasurementEpoch& epoch, const Ambiguities& ambiguities,
                   GpsTime last_update);
  // Sets gain_variance, and code_weighting_entry for accept(), of `entry` from its variance.
  // `inflation`: variance_inflation() of its noise. `correlation_time_ratio`: of this satellite's
  // correlation times to those of one in medium orbit. `reflected_walk`: what a reflection adds to
  // the random walk of the satellite's carrier, m/sqrt(s).
  void weigh(const MeasurementEpoch& epoch, const Measurement& code, double inflation,
             double correlation_time_ratio, double reflected_walk, FilterMeasurement* entry);

  // Returns whether carriers keep the position from epoch to epoch.
  bool carriers_keep_position() const { return continuity_ != CarrierContinuity::kNone; }

 private:
  // kNewArcs: whether the arcs last is not known yet.
  enum class CarrierContinuity { kNone, kNewArcs, kContinuous };
  CarrierContinuity evaluate_carrier_continuity(const MeasurementEpoch& epoch,
                                                const Ambiguities& ambiguities,
                                                GpsTime last_update);

  // Returns the inflated variance of a code whose errors last for `lasting_s` in a share of it.
  double inflated(double variance, double lasting_variance, double lasting_s,
                  double inflation) const;

  bool is_static_;
  ColoredCodeWeighting weighting_;
  double interval_s_ = 0.0;  // since the last update
  double mean_gain_ = 1.0, position_memory_s_ = 0.0;
  CarrierContinuity continuity_ = CarrierContinuity::kNone;
  GpsTime none_since_;                 // first of the epochs in which no arc went on
  GpsTime new_arcs_until_;             // no arc went on from before
  GpsTime frequent_arc_breaks_until_;  // too many arcs ended
};

}  // namespace leonav
