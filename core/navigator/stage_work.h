// What travels between the stages. In the daemon through rings, in Pipeline by a call.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <variant>

#include "core/ekf/ekf.h"
#include "core/gnss/antenna_model.h"
#include "core/gnss/ephemeris.h"
#include "core/gnss/observation.h"
#include "core/gnss/satellite_catalog.h"
#include "core/ins/imu.h"
#include "core/ins/odometer.h"
#include "core/navigator/checkpoint.h"
#include "core/navigator/outputs.h"
#include "core/smoother/keyframe.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

// A GNSS epoch has been issued: from the first IMU sample stamped with a deadline or later the
// navigator asks that mailbox for it.
struct EpochIssued {
  std::uint64_t index = 0;
  GpsTime time;               // t_k
  GpsTime deadline_ekf;       // tau + D_ekf
  GpsTime deadline_smoother;  // tau + D_smoother; unset: there is no smoother
};

// The filter starts over: what comes from epochs issued before this is worth nothing.
struct Restart {
  ResetCause cause = ResetCause::kCommand;  // or kTimeBase
};

// Sequencer -> InertialNavigator, in order.
using InertialWork = std::variant<ImuSample, EpochIssued, Restart>;

// An epoch with the IMU samples since the one before it, cut exactly at both ends.
struct EpochWork {
  std::uint64_t index = 0;
  GpsTime time;
  bool empty = false;  // no GNSS came in time: predict only
  RawEpoch raw;
  ImuBlock block;
  OdometerBlock odometer;  // that came since the epoch before and end by this one
};

enum class CommandKind : std::uint8_t { kRestart = 0, kSetHeading = 1 };
struct Command {
  CommandKind kind = CommandKind::kRestart;
  double value = 0.0;
  double sigma = 0.0;
  ResetCause cause = ResetCause::kCommand;  // of a restart; set by the Sequencer
};

// What one message told: at most one state of every satellite that has a name.
using PreciseStates = boost::container::static_vector<PreciseState, kMaxEphemerisSatellites>;

// Sequencer -> GnssStage, in order. A message is one piece of work, however much it tells: the
// stage may be an epoch's time behind.
using GnssWork = std::variant<Ephemeris, PreciseStates, KlobucharModel, AntennaPattern, Command,
                              Checkpoint, EpochWork>;

// GnssStage -> InertialNavigator, through the mailbox: the anchor to go on from.
struct EkfUpdate {
  std::uint64_t index = 0;
  bool valid = false;         // false: the filter is not initialized yet
  bool has_attitude = false;  // false: aligning; `state.q_eb` means nothing
  NavState state;             // at the epoch
  Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize> covariance =
      Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize>::Zero();
  bool gnss_used = false;  // at least one measurement counted in this epoch
  // Estimated: the state is of so much later than its stamp.
  double time_offset_s = 0.0;
  AttitudeWander wander;  // of the filter's process from here on
};

// SmootherStage -> InertialNavigator, likewise. Of an epoch that is no keyframe GnssStage has one
// delivered that says so.
struct SmootherUpdate {
  EkfUpdate anchor;  // valid: the smoother's answer
  bool due = false;  // false: it follows the last keyframe too soon to be one itself
  SmootherStatus status = SmootherStatus::kNoFilter;
  std::int32_t iterations = 0;
};

// GnssStage -> SmootherStage.
class KeyframeSink {
 public:
  virtual ~KeyframeSink() = default;
  // Where the next keyframe is to be written; nullptr: no room, the epoch is not to be one.
  virtual KeyframeInput* next_keyframe(std::uint64_t epoch) = 0;
  virtual void push_keyframe() = 0;
  // The epoch is none, not being due or having no room. `filter`: its answer.
  virtual void no_keyframe(const Solution& filter, bool due) = 0;
};

}  // namespace leonav
