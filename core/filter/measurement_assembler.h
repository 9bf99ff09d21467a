// MeasurementAssembler turns the measurements of an epoch into innovations with Jacobian and
// variance.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/code_variance_model.h"
#include "core/filter/error_model/learned_errors.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// A measurement that the update is not offered, with the reason.
struct ExcludedMeasurement {
  std::size_t index = 0;  // into MeasurementEpoch::measurements
  Reason reason = Reason::kNotSolved;
};
using ExcludedMeasurements = boost::container::static_vector<ExcludedMeasurement, kMaxMeasurements>;

// innovation = measured - h(x), linearized at MeasurementEpoch::approximate_p_e if that is given,
// otherwise at the prediction; h and its Jacobian are those of
// core/filter/update/measurement_model.h. Every measurement whose reason is kUsed becomes either an
// entry of measurements() or, with a reason, one of excluded(). It keeps the entries until the next
// epoch, because the smoother reads them and the code variances depend on which were used.
class MeasurementAssembler {
 public:
  explicit MeasurementAssembler(const EkfConfig& config)
      : config_(config), code_model_(config), errors_(config) {}

  void reset();
  // Forgets the codes used so far: the position they were weighed for no longer holds.
  void forget_codes() { code_model_.forget_codes(); }
  // `antenna`: as predicted to the epoch. `last_update`: time of the last update that used
  // measurements. Adds the ambiguities of new arcs to `estimate`.
  void assemble(const MeasurementEpoch& epoch, AntennaMotion antenna, GpsTime last_update,
                StateEstimate* estimate);

  // Fits the size of errors to the codes or Dopplers of a first epoch (LearnedErrors::fit_first()).
  // measurements() keep the variances that they have.
  bool fit_first_errors(const MeasurementEpoch& epoch, const ClockRemovedInnovations& innovations) {
    return errors_.fit_first(epoch, measurements_, innovations, standing());
  }
  // Tells how an update with measurements() has changed the variance of the position, m^2.
  void add_update(double before, double after) {
    code_model_.add_update(before, after, interval_s_);
  }
  // Learns from the codes of measurements(), or from the innovations of Dopplers, and ends the
  // epoch. `agree`: LearnedErrors::add_codes().
  void learn_codes(const MeasurementEpoch& epoch, const Eigen::Matrix4d& known_covariance,
                   bool agree) {
    errors_.add_codes(epoch, measurements_, known_covariance, {standing(), speed_}, agree);
  }
  void learn_dopplers(const MeasurementEpoch& epoch, const ClockRemovedInnovations& innovations) {
    errors_.add_dopplers(epoch, measurements_, innovations, standing());
  }
  void finish_learning(GpsTime time, bool agree) { errors_.end_epoch(time, agree); }
  const LearnedErrors& errors() const { return errors_; }
  bool carriers_keep_position() const { return code_model_.carriers_keep_position(); }
  LearnedSummary learned_summary() const { return errors_.summary(standing()); }
  void forget_errors() { errors_.reset(); }
  void start_errors(double code_sigma_factor, double doppler_sigma_factor, double share) {
    errors_.start(code_sigma_factor, doppler_sigma_factor, share);
  }

  FilterMeasurements* mutable_measurements() { return &measurements_; }
  const FilterMeasurements& measurements() const { return measurements_; }
  // Returns whether the antenna stood still at measurements().
  bool standing() const { return speed_ < kStandingSpeed_m_s; }
  // Returns the seconds from the update before to measurements().
  double interval_s() const { return interval_s_; }
  const ExcludedMeasurements& excluded() const { return excluded_; }
  int arcs_without_capacity() const { return arcs_without_capacity_; }
  // Moves entries to excluded(), as outliers.
  void exclude(Observable observable);
  void exclude_ranges();

 private:
  static constexpr double kStandingSpeed_m_s = 0.3;
  // Returns what a reflection may add to the random walk of a satellite's carrier, m/sqrt(s), from
  // one of its codes.
  double reflected_walk(const MeasurementEpoch& epoch, const Measurement& code,
                        double line_of_sight_rate) const;
  // Returns the random walk of a carrier's ambiguity, m/sqrt(s): Measurement::random_walk, and that
  // of a reflection.
  double random_walk(const MeasurementEpoch& epoch, const Measurement& carrier,
                     double line_of_sight_rate) const;
  // Sets variance and gain variance of `entry`; `dt`: seconds since the last update.
  void weigh(const MeasurementEpoch& epoch, const Measurement& measurement,
             double line_of_sight_rate, double dt, FilterMeasurement* entry);
  template <typename Predicate>
  void exclude_if(Predicate predicate);

  EkfConfig config_;
  CodeVarianceModel code_model_;
  LearnedErrors errors_;
  FilterMeasurements measurements_;
  ExcludedMeasurements excluded_;
  double interval_s_ = 0.0;  // from the update before to measurements_
  double speed_ = 0.0;       // of the antenna, m/s, at measurements_
  GpsTime epoch_time_;       // of measurements_
  int arcs_without_capacity_ = 0;
};

}  // namespace leonav
