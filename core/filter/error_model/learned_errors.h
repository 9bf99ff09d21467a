// LearnedErrors is what the filter has learned about the errors of its measurements.
#pragma once
#include "core/filter/error_model/error_correlation.h"
#include "core/filter/error_model/lasting_errors.h"
#include "core/filter/error_model/learned_summary.h"
#include "core/filter/error_model/sigma_scale.h"
#include "core/filter/error_model/signal_loss.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/state/ekf_config.h"

namespace leonav {

// It takes the residuals of codes and the clock-removed innovations of Dopplers, epoch by epoch,
// and gives scale and correlation of the errors of each class. It outlives restarts of the filter:
// the street stays.
class LearnedErrors {
 public:
  explicit LearnedErrors(const EkfConfig& config);
  // Returns to what is configured.
  void reset();
  // Takes factors on the configured sigmas from an earlier run, until errors are seen. `share`, 0
  // to 1, is how much of them still counts.
  void start(double code_sigma_factor, double doppler_sigma_factor, double share);

  bool learns() const { return learns_; }
  // Takes the strengths of an epoch's signals; before its measurements are weighed.
  void begin_epoch(const MeasurementEpoch& epoch) { losses_.add(epoch); }
  // Returns the class of a measurement of the last epoch; `satellite` is the one that it is of.
  ErrorClass class_of(const Measurement& measurement, const SatelliteInView& satellite,
                      bool standing) const {
    return error_class(measurement, satellite, losses_.loss_db(satellite), standing);
  }
  // Fits the size of one observable's errors to the first epoch, whose innovations are residuals of
  // the point solution that the filter starts from. Returns false if they are too few.
  bool fit_first(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                 const ClockRemovedInnovations& innovations, bool standing);
  // How the antenna moves at an epoch.
  struct Motion {
    bool standing = false;
    double speed_m_s = 0.0;
  };
  // Adds the codes of an epoch: their residuals (code_residuals()) at a position (ECEF) and a
  // zenith ionosphere delay known from before, with the covariance of these four, m^2. `agree` is
  // false where codes, carriers or Dopplers contradicted the prediction; then only lasting errors
  // are looked for, in what is not excluded.
  void add_codes(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                 const Eigen::Matrix4d& known_covariance, const Motion& motion, bool agree);
  // Adds the Dopplers of an epoch.
  void add_dopplers(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                    const ClockRemovedInnovations& innovations, bool standing);
  // Ends the epoch; `agree` as above.
  void end_epoch(GpsTime time, bool agree);

  // Returns by how much the sigma of a measurement is larger than configured.
  double sigma_scale(const ErrorClass& of) const { return learns_ ? scale_.scale(of) : 1.0; }
  // The same of an observable, without regard to the class.
  double mean_scale(Observable observable) const {
    return learns_ ? scale_.mean_scale(observable) : 1.0;
  }
  // Returns how the errors of a carrier are correlated, at a `speed` of the antenna in m/s.
  CorrelationModel carrier_correlation(double speed) const;
  // Returns how those of a code or Doppler are correlated in time, at a satellite in medium orbit.
  const CorrelationModel& correlation(const ErrorClass& of) const { return correlation_.model(of); }
  // Returns the errors of ranges that last for minutes, beyond what is stated.
  const LastingErrors& lasting() const { return lasting_; }
  // Returns the errors of a vehicle that stands, or moves.
  LearnedSummary summary(bool standing) const;

 private:
  bool learns_;
  SigmaScale scale_;
  ErrorCorrelation correlation_;
  SignalLoss losses_;
  LastingErrors lasting_;
  GpsTime last_time_;
};

}  // namespace leonav
