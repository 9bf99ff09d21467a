// Ekf is the tightly coupled extended Kalman filter: code, carrier phase and Doppler of every
// satellite against the inertial prediction.
#pragma once
#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <limits>
#include <span>

#include "core/filter/arc_joiner.h"
#include "core/filter/attitude_convergence.h"
#include "core/filter/estimate/antenna_model.h"
#include "core/filter/estimate/inertial_propagator.h"
#include "core/filter/estimate/speed_history.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/measurement_assembler.h"
#include "core/filter/prediction_test.h"
#include "core/filter/receiver_clocks.h"
#include "core/filter/state/ekf_config.h"
#include "core/filter/update/robust_update.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

// One scalar measurement as the filter treated it; index-parallel to
// MeasurementEpoch::measurements.
struct InnovationReport {
  double innovation = 0.0;           // measured minus predicted, m or m/s
  double innovation_variance = 0.0;  // m^2 or (m/s)^2
  double residual = 0.0;             // measured minus updated, m or m/s
  double test_ratio = 0.0;           // |innovation| over its standard deviation
  double weight_factor = 0.0;        // IGG-III
  Reason reason = Reason::kUsed;
};

// The effects of one update.
struct EkfUpdateResult {
  int used = 0;  // measurements with a factor above zero
  // Per Observable. Rejected: without weight or, where weights are switched off, with an innovation
  // that would have had none.
  std::array<int, kObservables> offered{};
  std::array<int, kObservables> rejected{};
  // Carriers that were rejected too often in a row: their arcs count as slipped, and their
  // ambiguities are removed at the next epoch.
  boost::container::static_vector<SatelliteId, kMaxArcs> slipped;
  int arcs_without_capacity = 0;
  int arcs_joined = 0;  // ArcJoiner
  double nis = 0.0;     // normalized innovation squared of the used measurements
  // Median |innovation| over its sigma of all codes or Dopplers offered, clocks removed, divided by
  // what it is for normal errors: 1 when all is well, whatever weights are used. NaN: fewer than
  // four.
  double code_ratio = std::numeric_limits<double>::quiet_NaN();
  double doppler_ratio = std::numeric_limits<double>::quiet_NaN();
  // The measurements agreed with each other but not with the prediction (PredictionTest).
  bool prediction_suspect = false;
  // Per Observable: 1 sigma, per axis, by which the prediction's position (by Dopplers: its
  // velocity) was made less certain for that, m (m/s); 0: it was not. Codes end all ambiguities
  // too, which had been found at a wrong position.
  std::array<double, kObservables> prediction_widened{};
  double lasting_error_found_m = 0.0;  // LastingErrors::Change::found_m
  double clock_jump_m = 0.0;           // these three: ClockSteps
  double code_step_m = 0.0;
  std::array<double, kMaxSystemTimes> inter_system_step_m{};
  boost::container::static_vector<InnovationReport, kMaxMeasurements> innovations;
};

// Ekf is an indirect filter of the error state in core/filter/state/ekf_state.h (Groves 2013,
// chapters 3 and 14). It only orders the steps of an epoch:
//   predict    InertialPropagator integrates the IMU, or coasts without attitude
//   constrain  StateEstimate applies motion constraints
//   update     MeasurementAssembler, ReceiverClocks, PredictionTest, then the robust update
// Its estimate is in its StateEstimate. It neither allocates after construction nor throws.
class Ekf {
 public:
  // `lever_arm_b`: from the IMU to the antenna in body axes, m.
  Ekf(const EkfConfig& config, const ImuErrorModel& imu, const Eigen::Vector3d& lever_arm_b);

  // --- start ---
  // Starts from a point solution of the antenna, with the constant-velocity (or static) model. Its
  // sigmas are scaled by the learned errors; the position is as much less certain as few redundant
  // codes leave it, and as ranges are whose errors last. A solution of no satellites is an estimate
  // whose covariance is taken as it is. A second call keeps the last IMU sample, the vehicle
  // constants and the learned errors, and forgets the rest.
  void initialize(GpsTime time, const PointSolution& point);
  // Forgets all but the configuration.
  void reset();
  // Call it before initialize(), if the vehicle constants are not to survive that.
  void reset_vehicle_constants();
  bool initialized() const { return initialized_; }
  // Takes what an earlier run has learned of the size of errors, as factors on the configured
  // sigmas. `share`, 0 to 1, is how much of it still counts. Does nothing once errors have been
  // seen.
  void start_errors(double code_sigma_factor, double doppler_sigma_factor, double share);
  // Takes vehicle constants from an earlier run, in the order of ekf_index, for initialize(). Does
  // nothing once the filter is initialized.
  void start_constants(const VehicleConstants& values, const VehicleConstants& variances);

  // --- attitude from outside ---
  // Goes over to the inertial model. The covariance of position, velocity and clocks is kept; the
  // position moves from antenna to IMU by the lever arm. Sigmas in rad and rad/s.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma);
  // The same with all IMU errors known, for example from a filter before a restart.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const ImuErrors& errors, const ImuErrorCovariance& covariance);
  // Replaces an attitude; its variances and correlations start anew, the antenna stays where it is.
  // Does nothing without an attitude.
  void replace_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy);
  // Goes back to the constant-velocity model: the position moves from IMU to antenna, and the IMU's
  // errors are forgotten. Does nothing without an attitude.
  void forget_attitude();
  // Takes position, velocity, attitude and IMU errors, with their covariance, from another estimate
  // of the same time (StateEstimate::replace_motion). The next update starts all clock offsets and
  // ambiguities again. Precondition: initialized, and not a static point.
  void replace_motion(const NavState& nav, const InertialCovariance& covariance,
                      const AttitudeRandomWalk& random_walk);
  // For `seconds` from now the attitude turns by a random walk of `noise`, rad/sqrt(s), beside that
  // of the gyros.
  void raise_attitude_noise(double noise, double seconds);
  bool has_attitude() const { return estimate_.has_attitude(); }

  // --- epoch ---
  // Predicts over `block` to `time`; `speeds`, if given, receives the state after every sample.
  void predict(std::span<const ImuSample> block, GpsTime time, SpeedHistory* speeds = nullptr);
  // Applies motion constraints to the state as it is (StateEstimate::constrain). Returns the
  // components used; none without an attitude.
  MotionComponents constrain(MotionMeasurements* measurements, double gate);
  // Uses the measurements whose reason is kUsed against the state as predicted to the epoch, with
  // IGG-III weights (core/filter/update/robust_update.h).
  EkfUpdateResult update(const MeasurementEpoch& epoch);
  // Restarts all clock offsets, with their ambiguities, at the next update.
  void restart_clock_offsets();
  // Allows for an error of `range_m` of a satellite that the updates so far have followed: raises
  // the covariance of what it may have moved (core/filter/update/fault_directions.h). `epoch`: that
  // of the last update. Does nothing if that had no carrier of the satellite.
  void allow_for_fault(SatelliteId satellite, double range_m, const MeasurementEpoch& epoch);
  // Begins to estimate a vehicle constant (kTravelYaw ... in ekf_index), with those before it. Does
  // nothing where it is estimated already. For the smoother the filter has then started over.
  void estimate_constant(int constant);

  // --- estimate ---
  const StateEstimate& estimate() const { return estimate_; }
  const FilterState& filter_state() const { return estimate_.state(); }
  const NavState& state() const { return estimate_.state().nav; }
  const EkfCovariance& covariance() const { return estimate_.covariance(); }
  const BodyMotion& body() const { return propagator_.body(); }
  // These return position and velocity of the antenna, ECEF, m and m/s.
  Eigen::Vector3d antenna_position_e() const { return antenna().p_e; }
  Eigen::Vector3d antenna_velocity_e() const { return antenna().v_e; }
  Eigen::Matrix3d antenna_position_covariance_e() const;  // m^2
  Eigen::Matrix3d antenna_velocity_covariance_e() const;  // (m/s)^2
  // Returns the vector from the estimated point to the antenna while there is no attitude, ECEF, m;
  // otherwise zero.
  Eigen::Vector3d vertical_antenna_offset_e() const;
  // What has been learned of the errors of its measurements.
  const LearnedErrors& learned_errors() const { return assembler_.errors(); }
  // What joins carrier arcs, and has learned whether they differ by whole cycles.
  const ArcJoiner& arc_joiner() const { return arc_joiner_; }
  // Returns whether carriers, and not codes, have kept the position since the last update.
  bool carriers_keep_position() const { return assembler_.carriers_keep_position(); }
  // Returns the present sizes and times of the errors of codes and Dopplers, for reports.
  LearnedSummary learned_summary() const { return assembler_.learned_summary(); }

  // --- for the smoother ---
  // Begins the process to the next keyframe (EkfConfig::keep_process).
  void begin_process() { estimate_.begin_process(); }
  // These return the measurements of the last update as it treated them, the seconds from the one
  // before to it, and the factor by which it raised the sigmas of an observable whose measurements
  // contradicted each other.
  const FilterMeasurements& measurements() const { return assembler_.measurements(); }
  double update_interval_s() const { return assembler_.interval_s(); }
  double sigma_inflation(Observable observable) const {
    return sigma_inflation_[static_cast<std::size_t>(observable)];
  }

 private:
  AntennaMotion antenna() const;
  // Takes lasting errors that the last update has found into the estimate, and into the weights of
  // codes.
  void allow_for_lasting_errors(const MeasurementEpoch& epoch);
  // Fits the size of errors to the first epoch after the point solution, and the latter's sigmas
  // with it. Returns whether the measurements must be assembled again, with these sizes.
  bool fit_first_errors(const MeasurementEpoch& epoch);
  void test_prediction(const MeasurementEpoch& epoch, const AntennaMotion& antenna,
                       EkfUpdateResult* result);
  // Inflates the covariance as the verdict says; where codes contradict the carriers' position, the
  // ambiguities start anew. Returns whether they did.
  bool inflate(double variance, Observable observable, const MeasurementEpoch& epoch,
               const AntennaMotion& antenna);
  void inflate_hidden_ambiguities(double sigma_m);
  void report_innovations(EkfUpdateResult* result) const;
  void report_update(const RobustUpdateResult& update, const MeasurementEpoch& epoch,
                     EkfUpdateResult* result);

  EkfConfig config_;
  ImuErrorModel imu_;
  AntennaModel antenna_model_;
  StateEstimate estimate_;
  InertialPropagator propagator_;
  MeasurementAssembler assembler_;
  ArcJoiner arc_joiner_;
  ReceiverClocks clocks_;
  PredictionTest prediction_test_;
  AttitudeConvergence attitude_convergence_;
  RobustUpdate robust_update_;
  std::array<double, kObservables> sigma_inflation_ = {1.0, 1.0, 1.0};  // in the last update
  LastingErrors::Change lasting_change_;                                // by the last update
  bool errors_unknown_;  // of measurements: no epoch has been seen since reset()
  GpsTime last_update_;
  bool initialized_ = false;
};

}  // namespace leonav
