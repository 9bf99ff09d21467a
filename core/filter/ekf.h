// The tightly coupled extended Kalman filter: code, carrier and Doppler of every satellite against
// the inertial prediction (or a constant-velocity or static one).
#pragma once
#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <limits>
#include <span>

#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/process/ins_transition.h"
#include "core/filter/speed_history.h"
#include "core/filter/state/ekf_config.h"
#include "core/filter/state/ekf_state.h"
#include "core/filter/state/filter_process.h"
#include "core/filter/state/filter_state.h"
#include "core/filter/update/colored_code_weighting.h"
#include "core/filter/update/measurement_model.h"
#include "core/filter/update/motion_constraint.h"
#include "core/filter/update/robust_update.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/imu_gap_fill.h"
#include "core/inertial/strapdown/mechanization.h"
#include "core/inertial/strapdown/nav_state.h"
#include "core/robust/common_step.h"

namespace leonav {

// One scalar measurement as the filter treated it; index-parallel to
// MeasurementEpoch::measurements.
struct InnovationReport {
  double innovation = 0.0;
  double innovation_variance = 0.0;
  double residual = 0.0;  // what the update left of the innovation
  double test_ratio = 0.0;
  double weight_factor = 0.0;
  Reason reason = Reason::kUsed;
};

struct EkfUpdateResult {
  int used = 0;  // measurements with a factor above zero
  // Rejected: without weight, or, where weights are switched off, as far out as if they were not.
  std::array<int, kObservables> offered{};  // per Observable
  std::array<int, kObservables> rejected{};
  // Carriers rejected too often in a row: the arc has slipped, whatever its checks said. Its
  // ambiguity goes with the next epoch.
  boost::container::static_vector<SatelliteId, kMaxArcs> slipped;
  bool ambiguities_reset = false;  // all began anew: they had been found at a wrong position
  int arcs_without_capacity = 0;
  double nis = 0.0;  // of the used ones
  // Median of |innovation| over its sigma, all codes or Dopplers offered, over what it is for
  // normal errors: 1 when all is well, whatever weights or a widened prior make of it. Clock jumps
  // taken out. NaN: fewer than four.
  double code_ratio = std::numeric_limits<double>::quiet_NaN();
  double doppler_ratio = std::numeric_limits<double>::quiet_NaN();
  // The measurements agreed with each other but not with the prediction. Ranges, and Dopplers
  // beside an IMU whose word no carrier contradicts: left out, and at the second such epoch in a
  // row believed: the covariance was widened. Other Dopplers at once.
  bool prediction_suspect = false;
  // Steps that the clocks' noise does not hold, taken up by the clocks; 0: none.
  double clock_jump_m = 0.0;                                // of all codes
  double code_step_m = 0.0;                                 // that part of it which no carrier made
  std::array<double, kMaxTimeBases> inter_system_step_m{};  // of one time base beyond it
  boost::container::static_vector<InnovationReport, kMaxMeasurements> innovations;
};

class Ekf {
 public:
  Ekf(const EkfConfig& config, const ImuErrorModel& imu, const Eigen::Vector3d& lever_arm_b);

  // Starts from a point solution of the antenna; without attitude: constant-velocity model. May be
  // called again: nothing of before remains, except the last IMU sample, which is still what the
  // body did.
  void initialize(GpsTime time, const PointSolution& point);
  // Forgets all but its configuration.
  void reset();
  // Goes on from `state` as if it were certain, its process begun: to integrate from elsewhere what
  // another filter has integrated. `last_sample`: the last one measured before; interval 0: none.
  void set_state(const FilterState& state, bool has_attitude, const ImuSample& last_sample);
  // Goes over to the inertial model: attitude and gyro bias given, covariance of position, velocity
  // and clocks kept; position moves from antenna to IMU centre by the lever arm.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma);
  // The same with all that is known of the IMU's errors, e.g. by a filter before a restart.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const ImuErrors& errors, const ImuErrorCovariance& covariance);
  // Corrects an attitude from outside: only its own variances and correlations change, and the
  // antenna stays where it is. Nothing without an attitude.
  void replace_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy);
  // For so long from now the attitude turns by a random walk of `noise`, rad/sqrt(s), beside that
  // of the gyros (AttitudeRandomWalk).
  void inflate_attitude_noise(double noise, double seconds);
  // The clocks' offsets start anew from the next epoch's codes, all arcs with them.
  void restart_clock_offsets();
  bool initialized() const { return initialized_; }
  bool has_attitude() const { return has_attitude_; }
  // False once a number has overflowed: nothing but a new filter helps.
  bool is_finite() const;

  // Predicts over `block` to `time`. Short holes are bridged
  // (core/inertial/strapdown/imu_gap_fill.h), also across blocks; over longer ones the motion goes
  // on at constant velocity with grown uncertainty. `speeds`, if given: is told of the state after
  // every sample.
  void predict(std::span<const ImuSample> block, GpsTime time, SpeedHistory* speeds = nullptr);

  // Just before initialize(): what is known of the vehicle's constants does not outlive this
  // filter.
  void reset_vehicle_constants();
  // From now on a constant of the vehicle is estimated that was not (set_state in ekf_index), with
  // those before it; nothing where it is already. For an estimator that looks back the filter has
  // started over.
  void estimate_constant(int constant);

  // Takes what constraints tell of the state as it is now, linearized there. Each component is
  // tested against the prediction; one that is further away than `gate` sigmas is left out. Returns
  // which were used, and says of each how it was met. Nothing without an attitude.
  MotionComponents constrain(MotionMeasurements* measurements, double gate);

  // Uses the code, carrier and Doppler of epoch.measurements whose reason is kUsed, against the
  // state as predicted to the epoch, linearized at epoch.approximate_p_e if that is given. IGG-III
  // on standardized innovations; the covariance stays symmetric and positive (robust_update.h).
  EkfUpdateResult update(const MeasurementEpoch& epoch);

  // For estimators that look back; kept only if EkfConfig::keep_process: the process since
  // begin_process(). Of the last update: its measurements, and by how much their sigmas were raised
  // because they contradicted each other.
  const FilterProcess& process() const { return process_; }
  void begin_process() {
    if (config_.keep_process) process_.begin(covariance_.rows());
  }
  const FilterMeasurements& measurements() const { return measurements_; }
  double sigma_inflation(Observable observable) const {
    return sigma_inflation_[static_cast<std::size_t>(observable)];
  }
  // The antenna beyond what the attitude tells of it.
  Eigen::Vector3d vertical_antenna_offset_e() const;

  const FilterState& filter_state() const { return state_; }
  const NavState& state() const { return state_.nav; }
  const ClockState& clocks() const { return state_.clocks; }
  const ClockFlags& known_clocks() const { return known_clocks_; }
  double wet_delay_m() const { return state_.wet_delay_m; }
  const VehicleConstants& vehicle() const { return state_.vehicle; }
  const Ambiguities& ambiguities() const { return state_.ambiguities; }
  const EkfCovariance& covariance() const { return covariance_; }
  Eigen::Vector3d antenna_position_e() const;
  Eigen::Vector3d antenna_velocity_e() const;
  // Of the antenna, with what is unknown of its lever arm and of the IMU's time; m^2, (m/s)^2.
  Eigen::Matrix3d antenna_position_covariance_e() const;
  Eigen::Matrix3d antenna_velocity_covariance_e() const;
  // Of the last IMU sample, errors not removed, rad/s: for the lever arm.
  const Eigen::Vector3d& measured_rate_b() const { return measured_rate_b_; }
  // Of the IMU over the last twentieth of a second, m/s^2: for the time offset, and zero where that
  // is not estimated.
  const Eigen::Vector3d& acceleration_e() const { return acceleration_e_; }

 private:
  // Whether carriers keep the position from epoch to epoch: they do not, too new to tell, they do.
  enum class CarrierContinuity { kNone, kNewArcs, kContinuous };

  double start_variance(int constant) const;
  void start_vehicle_constants(const VehicleConstants& before, const VehicleConstants& variances);
  VehicleConstants vehicle_variances() const;
  void predict_sample(const ImuSample& sample);
  void begin_sub_block();
  void finish_sub_block();
  void update_mean_acceleration(const Eigen::Vector3d& v_before_e, double interval_s);
  AntennaMotion antenna() const;
  bool attitude_has_converged();
  void inflate_vehicle_constants();
  Eigen::Matrix3d antenna_covariance_e(
      int first, const Eigen::Matrix<double, 3, ekf_index::kAntennaConstants>& slopes) const;
  void apply_antenna_transform(const AntennaMotion& antenna, double direction);
  Eigen::Vector3d vertical_arm_e(const Eigen::Vector3d& p_e) const;
  void apply_attitude(const AntennaMotion& before, const Eigen::Quaterniond& q_eb,
                      const Eigen::Vector3d& sigma_rpy, const EkfCovariance& of_antenna);
  void advance(const ImuSample& sample);
  void predict_imu_gap(GpsTime time, const ImuSample& next);
  void coast(GpsTime time);
  void drop_ended_arcs(const MeasurementEpoch& epoch);
  void free_ambiguity_states(const MeasurementEpoch& epoch);
  void assemble_measurements(const MeasurementEpoch& epoch);
  CarrierContinuity evaluate_carrier_continuity(const MeasurementEpoch& epoch);
  void weigh_code(const MeasurementEpoch& epoch, const Measurement& code,
                  double correlation_time_ratio, FilterMeasurement* entry);
  int find_or_add_ambiguity(const Measurement& carrier, SatelliteId satellite,
                            const FilterMeasurement& entry, GpsTime time);
  void inflate_disturbed_states(const MeasurementEpoch& epoch);
  void update_arc_rejection(const FilterMeasurement& measurement, GpsTime time,
                            EkfUpdateResult* result);
  double apply_code_step(const MeasurementEpoch& epoch, int base, const CommonStep& step);
  void apply_clock_step(const MeasurementEpoch& epoch, int base, const CommonStep& step);
  void compensate_clock_jump(const MeasurementEpoch& epoch, EkfUpdateResult* result);
  void compensate_inter_system_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result);
  void compensate_clock_steps(const MeasurementEpoch& epoch, EkfUpdateResult* result);
  bool start_clocks(const MeasurementEpoch& epoch, EkfUpdateResult* result);
  void test_prediction(const MeasurementEpoch& epoch, EkfUpdateResult* result);
  void report_innovations(const RobustUpdateResult& update, const MeasurementEpoch& epoch,
                          EkfUpdateResult* result);
  void count_epochs_without_accepted_code(const std::array<int, kMaxTimeBases>& offered,
                                          const std::array<int, kMaxTimeBases>& accepted);
  void restart_rejected_clocks();
  bool prediction_is_confirmed(Observable observable, double off,
                               const std::array<ClockRemovedInnovations, kObservables>& tables,
                               GpsTime time) const;
  template <typename Which>
  void exclude_if(Which which);
  void exclude_ranges();
  void reset_ambiguities();
  void drop_ambiguity(int set_state);
  // The covariance and, if it is kept, the process's noise: what adds to one adds to the other.
  boost::container::static_vector<EkfCovariance*, 2> covariance_and_noise();
  void start_offset(std::size_t base, double offset_m, double sigma_m);
  void start_drift(std::size_t base, double drift_m_s, double sigma_m_s);
  void copy_drift(std::size_t from, std::size_t to, double sigma_m_s);

  EkfConfig config_;
  ImuErrorModel imu_;
  Eigen::Vector3d lever_arm_b_;
  FilterState state_;
  ClockFlags known_clocks_;
  EkfCovariance covariance_ = EkfCovariance::Zero(ekf_index::kSize, ekf_index::kSize);
  FilterProcess process_;
  std::array<double, kObservables> sigma_inflation_ = {1.0, 1.0, 1.0};  // in the last update
  Mechanization mechanization_;
  InsTransition transition_;
  ImuSample last_sample_;  // that was measured, not filled in; interval 0: none yet
  // Of the last sample, errors not removed: for the lever arm.
  Eigen::Vector3d measured_rate_b_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_e_ = Eigen::Vector3d::Zero();
  // Of the attitude at the start of the vehicle's constants, rad; infinite: none yet.
  double start_tilt_sigma_ = std::numeric_limits<double>::infinity();
  double start_heading_sigma_ = std::numeric_limits<double>::infinity();
  GpsTime last_update_;
  struct ExcludedMeasurement {
    std::size_t index = 0;  // into MeasurementEpoch::measurements
    Reason reason = Reason::kNotSolved;
  };
  FilterMeasurements measurements_;  // of the epoch at hand
  boost::container::static_vector<ExcludedMeasurement, kMaxMeasurements>
      excluded_;             // of those offered
  GpsTime assembled_epoch_;  // the epoch they are of
  CarrierContinuity carrier_continuity_ = CarrierContinuity::kNone;
  GpsTime new_arcs_until_;             // no arc goes on from before
  GpsTime frequent_arc_breaks_until_;  // too many arcs have ended of late
  ColoredCodeWeighting code_weighting_;
  RobustUpdate robust_update_;
  int arcs_without_capacity_ = 0;  // in the epoch at hand
  // By which the last epoch's codes of a base were apart from the others'; 0: not.
  std::array<double, kMaxTimeBases> pending_inter_system_step_m_{};
  std::array<int, kMaxTimeBases>
      epochs_without_accepted_code_{};  // epochs in a row without a code accepted
  // The last epoch's, by a prediction that they agree against.
  bool ranges_inconsistent_ = false;  // ranges
  bool doppler_inconsistent_ = false;
  bool initialized_ = false;
  GpsTime last_consistent_time_;  // the last epoch whose codes the IMU's prediction agreed with
  bool has_attitude_ = false;
};

}  // namespace leonav
