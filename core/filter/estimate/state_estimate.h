// StateEstimate holds the filter's estimate: nominal state, covariance of its error, and which
// clocks are known.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/estimate/antenna_model.h"
#include "core/filter/process/ins_transition.h"
#include "core/filter/state/covariance_blocks.h"
#include "core/filter/state/ekf_config.h"
#include "core/filter/state/ekf_state.h"
#include "core/filter/state/filter_process.h"
#include "core/filter/state/filter_state.h"
#include "core/filter/update/measurement_model.h"
#include "core/filter/update/motion_constraint.h"
#include "core/filter/update/robust_update.h"
#include "core/gnss/positioning/point_solution.h"
#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {

// StateEstimate is the only class that writes the filter's covariance. Every step of the filter
// that changes the Gaussian is one of its functions. The equations of models and updates are in
// state/, process/ and update/, as functions of a matrix; those of the steps between them (antenna
// transform, attitude from outside, noise of gaps and coasting, clock steps, scalar constraints,
// vehicle constants) are in state_estimate.cc.
//
// Beside the covariance it records the process F, N since begin_process() for the smoother
// (core/filter/state/filter_process.h). What adds noise to the covariance adds it to N too.
class StateEstimate {
 public:
  explicit StateEstimate(const EkfConfig& config);

  const FilterState& state() const { return state_; }
  // Returns the covariance of the error state, in the order of ekf_index; SI units.
  const EkfCovariance& covariance() const { return covariance_; }
  const ClockFlags& known_clocks() const { return known_clocks_; }
  bool has_attitude() const { return has_attitude_; }
  // Returns false once a number has overflowed: only a new filter helps then.
  bool is_finite() const;
  // Returns the process since begin_process(); it is recorded only if EkfConfig::keep_process.
  const FilterProcess& process() const { return process_; }
  void begin_process();

  // --- start ---
  // Starts from a point solution of the antenna, without attitude. `antenna_offset_e` leads from
  // the estimated point to the antenna, m. Vehicle constants keep values and variances, not their
  // correlations.
  void initialize(GpsTime time, const PointSolution& point,
                  const Eigen::Vector3d& antenna_offset_e);
  // Takes `state` as certain and begins its process, without ambiguities and known clocks.
  void set_exactly(const CoreState& state, bool has_attitude);
  // Sets the vehicle constants, as many variances as values; to be followed by initialize().
  void set_vehicle_constants(const VehicleConstants& values, const VehicleConstants& variances);
  // Removes the vehicle constants; to be followed by initialize().
  void remove_vehicle_constants() { state_.vehicle.clear(); }
  void forget_clocks() { known_clocks_ = ClockFlags{}; }

  // --- attitude from outside the filter ---
  // Sets attitude and IMU errors with their covariances; the antenna keeps position and velocity.
  // `sigma_rpy`: of roll, pitch and yaw, rad.
  void set_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                    const ImuErrors& errors, const ImuErrorCovariance& covariance,
                    const AntennaModel& model, const BodyMotion& body);
  // Replaces the attitude alone; IMU errors keep their values and correlations.
  void replace_attitude(const Eigen::Quaterniond& q_eb, const Eigen::Vector3d& sigma_rpy,
                        const AntennaModel& model, const BodyMotion& body);
  // Forgets attitude and IMU errors; the antenna keeps position and velocity, with their
  // covariance. Precondition: there is an attitude.
  void forget_attitude(const AntennaModel& model, const BodyMotion& body);
  // Replaces position, velocity, attitude and IMU errors, with their covariance, by another
  // estimate's of the same time. All other states keep their values and variances and lose their
  // correlations with these; ambiguities end.
  void replace_motion(const NavState& nav, const InertialCovariance& covariance,
                      const AttitudeRandomWalk& random_walk);
  // Until `seconds` from now the attitude turns by a random walk of `noise`, rad/sqrt(s), beside
  // that of the gyros.
  void raise_attitude_noise(double noise, double seconds);

  // --- time update ---
  // Sets the mechanized inertial state.
  void set_inertial_state(const NavState& nav) { state_.nav = nav; }
  // P <- Phi P Phi^T + Q of one sub-block of IMU samples.
  void propagate(const InsTransition& transition);
  // Adds the uncertainty of an IMU sample that was filled in.
  void add_gap_noise(const ImuGapFill& gap_fill);
  // Moves on at constant velocity to `time`, with the configured acceleration noise; a static point
  // stays.
  void coast(GpsTime time);
  // Moves clocks, IMU errors, ambiguities, wet delay and vehicle constants on by `dt` seconds.
  void propagate_slow_states(const ImuErrorModel& imu, double dt);

  // --- measurement update ---
  // Makes position and velocity in the error state those of the antenna, as far as lever arm and
  // time offset move it, so that rows need no columns for these constants. correct() ends it.
  void to_antenna_parametrization(const AntennaMotion& antenna);
  // Applies the robust update, in the antenna's parametrization, and leaves that.
  RobustUpdateResult correct(const RobustConfig& config, const AntennaMotion& antenna,
                             FilterMeasurements* measurements, RobustUpdate* robust_update);
  // Applies motion constraints one by one, in Joseph's form, linearized at the state as it is. A
  // component further than `gate` sigmas from its prediction is left out. Fills each measurement's
  // outputs and returns the components used; needs an attitude.
  MotionComponents constrain(MotionMeasurements* measurements, double gate);

  // --- inflation ---
  // Inflates what an observable sees first (inflate_covariance() in
  // core/filter/update/covariance_inflation.h), m^2 or (m/s)^2.
  void inflate(Observable observable, double variance, double interval_s);
  void inflate_position(double sigma_m);
  // Adds an error of this size and direction, of either sign.
  void inflate_along(const EkfCorrection& error);
  // Multiplies the sigmas of position and velocity, correlations stay.
  void scale_sigmas(double of_position, double of_velocity);
  void inflate_ambiguity(int state, double sigma_m);

  // --- ionosphere ---
  // Sets the sigma of the zenith delay beyond the modelled one, a Gauss-Markov process; the first
  // call starts it.
  void set_ionosphere_sigma(double sigma_m);
  // Follows a step of the modelled zenith delay, m, which becomes as uncertain as it is large.
  void step_ionosphere_model(double step_m);

  // --- clocks; `system` is an index of System ---
  void start_clock_offset(std::size_t system, double offset_m, double sigma_m);
  void start_clock_drift(std::size_t system, double drift_m_s, double sigma_m_s);
  // Starts a drift as that of another system, with `sigma_m_s` between them.
  void copy_clock_drift(std::size_t from, std::size_t to, double sigma_m_s);
  void forget_clock_offset(std::size_t system) { known_clocks_.offset[system] = false; }
  // Shifts the known clocks of `system` (or kAllSystems) by a step that codes and carriers share.
  void shift_clocks(int system, double step_m, double sigma_m);
  // Shifts them by a step of the codes alone: ambiguities make up for it. `sigma_m` 0: exact.
  void shift_codes_against_carriers(int system, double step_m, double sigma_m);

  // --- ambiguities; `state` is an index of the error state, `index` one of
  // FilterState::ambiguities ---
  const Ambiguity& ambiguity_of_state(int state) const;
  // These leave the covariance as it is.
  void shift_ambiguity(int state, double shift_m);
  void set_ambiguity_random_walk(int state, double random_walk);
  // Records that the update at `time` used the ambiguity's carrier, or rejected it.
  void record_carrier(int state, GpsTime time, bool used);
  void add_ambiguity(const Ambiguity& ambiguity, double sigma_m);
  void remove_ambiguity(int index);
  // Applies ambiguity `to` minus ambiguity `from` = difference_m, with an error of `sigma_m`.
  void join_ambiguities(int from, int to, double difference_m, double sigma_m);
  // Notes with ambiguity `to` that its join to `from` is wrong with this probability, and by how
  // much its value then changes; what `from` was joined to counts on.
  void record_join(int from, int to, double wrong_probability, double wrong_m);

  // --- vehicle constants ---
  // Appends constants up to `constant` (kTravelYaw ... in ekf_index) before the ambiguities, each
  // at zero with its configured sigma.
  void add_vehicle_constants(int constant);
  // Gives every constant its start variance again, uncorrelated; value and antenna stay.
  void restart_vehicle_constants(const AntennaMotion& antenna);

 private:
  // Returns the covariance and, if it is recorded, the process's noise.
  boost::container::static_vector<EkfCovariance*, 2> covariance_and_noise();
  void start_vehicle_constants();
  void apply_attitude(const AntennaMotion& before, const Eigen::Quaterniond& q_eb,
                      const Eigen::Vector3d& sigma_rpy, const EkfCovariance& of_antenna,
                      const AntennaModel& model, const BodyMotion& body);
  Ambiguity& mutable_ambiguity_of_state(int state);
  void propagate_ionosphere(double dt);
  void apply_antenna_transform(const AntennaMotion& antenna, double direction);

  EkfConfig config_;
  FilterState state_;
  ClockFlags known_clocks_;
  EkfCovariance covariance_ = EkfCovariance::Zero(ekf_index::kSize, ekf_index::kSize);
  FilterProcess process_;
  double ionosphere_variance_ = 0.0;  // m^2, of its process; 0: its delay is not estimated
  bool has_attitude_ = false;
};

}  // namespace leonav
