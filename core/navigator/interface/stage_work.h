// These are the messages that the stages exchange, through rings in the daemon and by calls in
// Navigator.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <variant>

#include "core/filter/ekf.h"
#include "core/filter/state/covariance_blocks.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/propagation/antenna_model.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/odometer.h"
#include "core/integrity/level_growth.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/event.h"
#include "core/navigator/interface/solution.h"
#include "core/smoother/keyframe.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

// An epoch has been issued. At the first IMU sample stamped with a deadline or later (or
// TimeWithoutImu, where none comes) the inertial stage takes the epoch's result from the mailbox of
// that deadline.
struct EpochIssued {
  std::uint64_t index = 0;    // k
  GpsTime time;               // t_k
  GpsTime deadline_ekf;       // tau + D_ekf, with tau the time of the data at the issue
  GpsTime deadline_smoother;  // tau + D_smoother, not before deadline_ekf; unset: no smoother
};

// The filter starts over. Results of epochs that were issued earlier are not used.
struct Restart {
  ResetCause cause = ResetCause::kCommand;  // kCommand or kTimeBase
};

// The IMU is silent, and the time of the data has gone on to that of the newest epoch.
struct TimeWithoutImu {
  GpsTime time;
};

// Work from the Sequencer to the InertialNavigator, in order.
using InertialWork = std::variant<ImuSample, EpochIssued, Restart, TimeWithoutImu>;

// An epoch with the IMU samples since the one before it, cut exactly at both ends.
struct EpochWork {
  std::uint64_t index = 0;  // k
  GpsTime time;
  bool empty = false;  // no GNSS came in time: the filter only predicts
  RawEpoch raw;
  ImuBlock block;
  OdometerBlock odometer;  // increments received since the epoch before that end by this one
  // The smoother's deadline of the epoch before has passed: its result is decided.
  bool smoother_decided = false;
};

// On the wire: append only.
enum class CommandKind : std::uint8_t { kRestart = 0, kSetHeading = 1 };
// A command from outside.
struct Command {
  CommandKind kind = CommandKind::kRestart;
  double value = 0.0;                       // kSetHeading: heading, rad, clockwise from north
  double sigma = 0.0;                       // kSetHeading: its sigma, rad
  ResetCause cause = ResetCause::kCommand;  // kRestart: set by the Sequencer
  // The sender's count; nullopt: not from outside, and not answered.
  std::optional<std::uint64_t> sequence = std::nullopt;
  // Data time at which it came, and at which a heading holds; set by the Sequencer.
  GpsTime time = {};
};

// The precise states of one message, with room for one of each satellite that has a name.
using PreciseStates = boost::container::static_vector<PreciseState, kMaxEphemerisSatellites>;

// The corrected states of one message, and the signal biases of one message.
using CorrectedStates = boost::container::static_vector<CorrectedState, kMaxCorrectedStates>;
using SignalBiases = boost::container::static_vector<SignalBias, kMaxBiases>;

// Work from the Sequencer to the GnssStage, in order. A message is one piece of work whatever its
// length, so that a stage that is an epoch behind needs few slots in its ring.
using GnssWork = std::variant<Ephemeris, PreciseStates, CorrectedStates, SignalBiases,
                              KlobucharModel, AntennaPattern, Command, Checkpoint, EpochWork>;

// The state and covariance at an epoch from which the inertial stage propagates the solution. The
// GnssStage delivers it through a mailbox.
struct Anchor {
  std::uint64_t index = 0;    // k
  bool valid = false;         // false: the filter is not initialized yet
  bool has_attitude = false;  // false: aligning, and `state.q_eb` has no meaning
  NavState state;             // at the epoch
  InertialCovariance covariance = InertialCovariance::Zero();
  bool gnss_used = false;  // at least one measurement was used in this epoch
  // The estimated time offset: the state is valid this much later than its stamp.
  double time_offset_s = 0.0;
  AttitudeRandomWalk random_walk;  // inflated attitude noise of the filter from here on
  LevelGrowth levels;              // protection levels from here on
};

// The smoother's result at an epoch. The SmootherStage delivers it through a mailbox of its own.
// For an epoch that is no keyframe it delivers one whose anchor is not valid.
struct SmootherAnchor {
  Anchor anchor;     // valid: the smoother has a state
  bool due = false;  // false: the epoch follows the last keyframe too soon to be one itself
  SmootherStatus status = SmootherStatus::kNoFilter;
  std::int32_t iterations = 0;
  bool filter_may_follow = false;  // SmootherResult::filter_may_follow
};

// KeyframeSink takes keyframes from the GnssStage to the SmootherStage.
class KeyframeSink {
 public:
  virtual ~KeyframeSink() = default;
  // Returns the keyframe to write next; nullptr: there is no room, so the epoch is no keyframe.
  virtual KeyframeInput* next_keyframe(std::uint64_t epoch) = 0;
  // Passes on the keyframe that next_keyframe() returned.
  virtual void push_keyframe() = 0;
  // Reports that the epoch is no keyframe, because none is due or there is no room. `filter` is the
  // filter's solution at the epoch.
  virtual void no_keyframe(const Solution& filter, bool due) = 0;
  // Returns the smoother's result of an epoch whose deadline has passed in data time; false: it was
  // a miss, and remains one.
  virtual bool result_of(std::uint64_t epoch, SmootherAnchor* result) = 0;
};

}  // namespace leonav
