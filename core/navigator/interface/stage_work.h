// The stages exchange these messages, through rings in the daemon and by calls in Navigator.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <variant>

#include "core/filter/ekf.h"
#include "core/filter/state/covariance_blocks.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/propagation/antenna_model.h"
#include "core/gnss/signals/observation.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/odometer.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/solution.h"
#include "core/smoother/keyframe.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

// A GNSS epoch has been issued. At the first IMU sample stamped with a deadline or later, the
// inertial stage takes the epoch's result from the mailbox of that deadline.
struct EpochIssued {
  std::uint64_t index = 0;
  GpsTime time;               // t_k
  GpsTime deadline_ekf;       // tau + D_ekf
  GpsTime deadline_smoother;  // tau + D_smoother; unset: there is no smoother
};

// The filter starts over: results of epochs issued before this are not used.
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
  OdometerBlock odometer;  // received since the epoch before, ending by this one
};

enum class CommandKind : std::uint8_t { kRestart = 0, kSetHeading = 1 };
struct Command {
  CommandKind kind = CommandKind::kRestart;
  double value = 0.0;
  double sigma = 0.0;
  ResetCause cause = ResetCause::kCommand;  // of a restart; set by the Sequencer
};

// The states of one message: at most one of each satellite that has a name.
using PreciseStates = boost::container::static_vector<PreciseState, kMaxEphemerisSatellites>;

// Sequencer -> GnssStage, in order. A message is one piece of work, whatever its length, for the
// stage may be behind by an epoch.
using GnssWork = std::variant<Ephemeris, PreciseStates, KlobucharModel, AntennaPattern, Command,
                              Checkpoint, EpochWork>;

// GnssStage -> InertialNavigator, through the mailbox: the anchor to go on from.
struct Anchor {
  std::uint64_t index = 0;
  bool valid = false;         // false: the filter is not initialized yet
  bool has_attitude = false;  // false: aligning; `state.q_eb` means nothing
  NavState state;             // at the epoch
  InertialCovariance covariance = InertialCovariance::Zero();
  bool gnss_used = false;  // at least one measurement counted in this epoch
  // Estimated: the state is valid this much later than its stamp.
  double time_offset_s = 0.0;
  AttitudeRandomWalk random_walk;  // of the filter's process from here on
};

// SmootherStage -> InertialNavigator, through a mailbox of its own. For an epoch that is no
// keyframe a result without an answer is delivered.
struct SmootherAnchor {
  Anchor anchor;     // valid: the smoother's answer
  bool due = false;  // false: it follows the last keyframe too soon to be one itself
  SmootherStatus status = SmootherStatus::kNoFilter;
  std::int32_t iterations = 0;
};

// GnssStage -> SmootherStage.
class KeyframeSink {
 public:
  virtual ~KeyframeSink() = default;
  // The keyframe to write next; nullptr: no room, the epoch is not to be one.
  virtual KeyframeInput* next_keyframe(std::uint64_t epoch) = 0;
  virtual void push_keyframe() = 0;
  // The epoch is no keyframe, because none is due or there is no room. `filter`: its solution.
  virtual void no_keyframe(const Solution& filter, bool due) = 0;
};

}  // namespace leonav
