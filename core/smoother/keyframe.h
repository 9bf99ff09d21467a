// What the smoother is told of one epoch, and what it keeps of it.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>

#include "core/capacity.h"
#include "core/ekf/filter_process.h"
#include "core/ekf/filter_state.h"
#include "core/ekf/motion_constraint.h"
#include "core/gnss/measurement.h"
#include "core/ins/imu.h"

namespace leonav {

// One measurement of a keyframe. What it weighs is factor / gain_variance.
struct KeyframeMeasurement {
  Measurement measurement;  // satellite_index: into the keyframe's satellites
  int ambiguity = -1;       // place among the state's ambiguities; -1: none
  double variance = 0.0;    // of the measurement alone: what it is tested against
  double gain_variance = 0.0;
  double factor = 1.0;    // IGG-III: the filter's, later the window's
  double residual = 0.0;  // at the estimate where the window decided it, m or m/s
};
using KeyframeMeasurements = boost::container::static_vector<KeyframeMeasurement, kMaxMeasurements>;
using KeyframeSatellites = boost::container::static_vector<SatelliteInView, kMaxMeasurements>;

// Of one epoch, as the filter has treated it (the same measurements, corrections, variances).
struct KeyframeInput {
  std::uint64_t index = 0;  // k
  GpsTime time;
  bool valid = false;   // the filter has a state
  bool linked = false;  // to the keyframe before; false: the filter has started over since
  bool has_attitude = false;
  bool has_gnss = false;  // the filter has used some of late
  FilterState from;       // the filter's at the keyframe before, after its update
  FilterState prior;      // as predicted from there, clock steps taken up
  FilterProcess process;  // likewise
  FilterState state;      // the filter's, after its update
  EkfCovariance covariance;
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();  // rad/s, for the lever arm
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();   // m/s^2, for the time offset
  Eigen::Vector3d mast_e = Eigen::Vector3d::Zero();  // m, antenna beyond what the attitude tells
  KeyframeSatellites satellites;
  KeyframeMeasurements measurements;
  ImuBlock block;               // since the keyframe before
  bool block_whole = false;     // nothing of it is missing here
  ImuSample before_block;       // the last measured one before it; interval 0: none
  ConstraintInstants instants;  // constraints on the motion in it
};

// The states that are estimated: those core states (before the ambiguities) whose variance is not
// zero, in order, and all ambiguities.
struct ActiveStates {
  boost::container::static_vector<int, ekf_index::kSize + ekf_index::kMaxVehicle> core;
  int before_ambiguities = ekf_index::kSize;  // states, with those that are not estimated
  int ambiguities = 0;

  Eigen::Index core_size() const { return static_cast<Eigen::Index>(core.size()); }
  Eigen::Index size() const { return core_size() + ambiguities; }
};

// The process from the keyframe before, about the pair of states it was linearized at:
//   (x - to) = F (x_before - from) + w,  w ~ N,  in active states.
struct KeyframeLink {
  FilterState from, to;
  EkfCovariance F;      // size x size before
  EkfCovariance noise;  // N; zero where the process does not move a state
  // Where constraints on the motion between the two were met: what they tell of the keyframe before
  // beyond this, 0.5 e^T information e - gradient^T e with e = x_before - from.
  bool informed = false;
  EkfCovariance information;
  EkfCorrection gradient;
};

struct Keyframe {
  std::uint64_t index = 0;
  GpsTime time;
  bool has_attitude = false;
  ActiveStates active;
  FilterState state;  // the estimate
  KeyframeLink link;  // of all but the window's first
  Eigen::Vector3d measured_rate_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d mast_e = Eigen::Vector3d::Zero();
  KeyframeSatellites satellites;
  KeyframeMeasurements measurements;
  bool judged = false;  // its factors have been decided here, not only by the filter
  ImuBlock block;
  bool block_whole = false;
  ImuSample before_block;
  ConstraintInstants instants;
};

// Between an error of all states and one of the active ones.
EkfCorrection active_part(const ActiveStates& active, const EkfCorrection& error);
EkfCorrection whole_error(const ActiveStates& active, const EkfCorrection& part);

}  // namespace leonav
