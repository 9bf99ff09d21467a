// Keyframe holds one epoch in the smoother's window: its state, its process factor and its
// measurements.
//
// Terms as in Dellaert and Kaess, Factor Graphs for Robot Perception, 2017. States are those of the
// filter (core/filter/state/filter_state.h), with errors as "true minus estimate".
// Frames: e ECEF, b body.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/base/capacity.h"
#include "core/filter/state/filter_process.h"
#include "core/filter/state/filter_state.h"
#include "core/filter/update/motion_constraint.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/strapdown/imu.h"
#include "core/integrity/fault_hypothesis.h"

namespace leonav {

// One measurement of a keyframe; its weight is factor / gain_variance.
struct KeyframeMeasurement {
  MeasuredObservable measurement;  // satellite_index: into the keyframe's satellites
  int ambiguity = -1;              // index among the state's ambiguities; -1: none
  double variance = 0.0;           // of the measurement alone, for its test
  double gain_variance = 0.0;
  double factor = 1.0;    // IGG-III: first the filter's, later the window's
  double residual = 0.0;  // at the estimate where the window decided the factor, m or m/s
};
using KeyframeMeasurements = boost::container::static_vector<KeyframeMeasurement, kMaxMeasurements>;
using KeyframeSatellites = boost::container::static_vector<SatelliteGeometry, kMaxMeasurements>;

// Two ambiguities of a keyframe whose arcs the filter has joined since: `to` minus `from` is
// difference_m, with the variance given in m^2.
struct ArcJoin {
  int from = 0, to = 0;  // indices of ambiguities
  double difference_m = 0.0, variance = 0.0;
};
using ArcJoins = boost::container::static_vector<ArcJoin, kMaxArcs>;

// The input for one keyframe: an epoch as the filter has treated it, with the same measurements,
// corrections and variances.
struct KeyframeInput {
  std::uint64_t index = 0;  // k
  GpsTime time;
  bool valid = false;  // the filter has a state
  // The filter has not started over since the previous keyframe.
  bool follows_previous = false;
  // An attitude from outside has replaced the filter's since then (FilterProcess::replaced).
  bool attitude_replaced = false;
  // The filter has started over since then, because of something that the window has wrong too.
  bool ends_window = false;
  bool has_attitude = false;
  bool has_gnss = false;  // the filter has used GNSS recently
  FilterState from;       // the filter's at the previous keyframe, after its update
  FilterState prior;      // predicted from `from`, with clock steps applied
  FilterProcess process;  // from `from` to `prior`
  FilterState state;      // the filter's, after its update
  EkfCovariance covariance;
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();  // rad/s, for the lever arm
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();   // m/s^2, for the time offset
  // Antenna minus the position of the state, m, where no attitude relates the two.
  Eigen::Vector3d vertical_antenna_offset_e = Eigen::Vector3d::Zero();
  KeyframeSatellites satellites;
  KeyframeMeasurements measurements;
  ImuBlock block;                 // since the previous keyframe
  bool block_complete = false;    // no sample is missing
  ImuSample sample_before_block;  // the last measured sample before the block; interval 0: none
  ConstraintInstants instants;    // motion constraints within the block
  FaultHypotheses fault_hypotheses;
};

// Returns the joins of arcs between the previous keyframe's ambiguities.
ArcJoins joins_of(const KeyframeInput& input);

// The states that are estimated: the core states (before the ambiguities) whose variance is not
// zero, in order, and all ambiguities.
struct ActiveStates {
  boost::container::static_vector<int, ekf_index::kMaxCore> core;
  // number of core states, including those not estimated
  int before_ambiguities = ekf_index::kSize;
  int ambiguities = 0;

  Eigen::Index core_size() const { return static_cast<Eigen::Index>(core.size()); }
  Eigen::Index size() const { return core_size() + ambiguities; }
};

// The process factor from the previous keyframe, linearized at a pair of states:
//   (x - to) = F (x_before - from) + w,  w ~ N,  in active states.
// It corresponds to the preintegrated IMU factor of Forster et al. (IEEE T-RO 33(1), 2017), here
// with Earth rotation, clocks and ambiguities.
struct ProcessFactor {
  FilterState from, to;
  EkfCovariance F;      // size x size of the previous keyframe's active states
  EkfCovariance noise;  // N; zero for a state that the process does not change
  // Motion constraints between the two keyframes were applied. They give additional information
  // about the previous one: the cost 0.5 e^T information e - gradient^T e with e = x_before - from.
  // They concern its core states alone: `information` has their rows and columns only.
  bool has_information = false;
  BoundedMatrix<ekf_index::kMaxCore, ekf_index::kMaxCore> information;
  EkfCorrection gradient;
  ArcJoins joins;  // of ambiguities of the previous keyframe
};

// One keyframe of the window.
struct Keyframe {
  std::uint64_t index = 0;
  GpsTime time;
  bool has_attitude = false;
  ActiveStates active;
  FilterState state;             // the estimate
  ProcessFactor process_factor;  // unused in the window's first keyframe
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d vertical_antenna_offset_e = Eigen::Vector3d::Zero();
  KeyframeSatellites satellites;
  KeyframeMeasurements measurements;
  bool weights_decided = false;  // its factors were decided by the window, not only by the filter
  ImuBlock block;
  bool block_complete = false;
  ImuSample sample_before_block;
  ConstraintInstants instants;
};

// These convert between an error of all states and one of the active states.
EkfCorrection active_part(const ActiveStates& active, const EkfCorrection& error);
EkfCorrection full_error(const ActiveStates& active, const EkfCorrection& part);

}  // namespace leonav
