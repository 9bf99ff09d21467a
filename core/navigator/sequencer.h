// Gives every input its place in one total order and cuts the IMU stream at the GNSS epochs.
#pragma once
#include <array>
#include <boost/circular_buffer.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/conventions/refused_imu.h"
#include "core/conventions/stamp_offset.h"
#include "core/navigator/event_source.h"
#include "core/navigator/imu_stamps.h"
#include "core/navigator/navigator_config.h"
#include "core/navigator/odometer_queue.h"
#include "core/navigator/stage_work.h"
#include "core/navigator/time_base_watch.h"

namespace leonav {

// Where the Sequencer's work goes. push_* may wait for room, never drop.
class StageInputs {
 public:
  virtual ~StageInputs() = default;
  // Called before the epoch's work is pushed to either stage.
  virtual void open_epoch(std::uint64_t index) = 0;
  virtual void push_inertial(const InertialWork& work) = 0;
  virtual void push_gnss(const GnssWork& work) = 0;
  virtual void event(const Event& event) = 0;  // sequencer's own events, sequence counted per stage
};

// Codes of EventKind::kCapacity from this stage.
enum class SequencerCapacity : std::uint8_t {
  kPendingEpochs = 0,  // value: index of the epoch that was issued without its IMU
};

// Decides by data alone, so replay decides alike:
// - an epoch is issued when the IMU has passed its time; without IMU
//   (MotionModel::kConstantVelocity) at once, and then nothing goes to the inertial stage;
// - an epoch waits for its IMU until ones more than kMaxImuLatencyNs later wait too, and more than
//   kMinPending of them, or until kMaxPendingEpochs wait. Then it is issued without all of its IMU:
//   counted, and reported as kCapacity (SequencerCapacity::kPendingEpochs);
// - when the IMU has run one epoch interval and the wait for a GNSS latency past the last epoch, an
//   empty epoch is issued one interval after that last one, so that blocks stay bounded; after a
//   hole in the IMU stream it is issued at the hole's end. The first IMU sample's start counts as
//   an epoch for this. The wait is the configured allowance, at least half an epoch interval; an
//   epoch that comes after an empty one took its place makes it longer, up to kMaxGnssLatencyNs, so
//   that a steady latency costs one epoch and not all;
// - an epoch not later than the last issued one is late: counted, dropped, reported; one that is
//   merely out of order takes its place among those waiting;
// - IMU stamps are moved by the configured time offset before anything looks at them;
// - IMU samples must be finite, in range and increasing (kTimeBackwards). Their stamps may jitter:
//   ImuStamps lays them end to end; increments stay, intervals change. A gap is reported and left
//   as a hole; where it is longer than kImuLeapNs its first sample is held until the next one,
//   which tells by being later or earlier than it whether it is a gap or one wild stamp;
// - an IMU stamp more than kMaxAheadS beyond everything seen (kTooFarAhead), or behind, is rejected
//   until a run of consistent ones shows that time itself has changed: then everything restarts in
//   the new time. The same holds for epochs while the IMU keeps time, except that "too far" is
//   three epoch intervals where those are longer;
// - where GNSS alone keeps time (no IMU, or none yet) an outage cannot be told from a wild stamp by
//   itself. Such an epoch is held until the next one, which tells by being later or earlier than
//   it. So an outage of any length, or an interval other than configured, costs no epoch;
// - odometer increments go with the epoch that they end by: OdometerQueue;
// - GNSS does not change the time while IMU samples keep arriving in the old one.
class Sequencer {
 public:
  static constexpr std::size_t kMinPending = 4;
  static constexpr std::int64_t kMaxImuLatencyNs = 2'000'000'000;
  static constexpr double kMaxAheadS = 10.0;
  static constexpr double kMaxAheadIntervals = 3.0;  // of epochs, where that is more
  static constexpr std::int64_t kMaxGnssLatencyNs = 2'000'000'000;
  static constexpr double kMaxEpochStepS = 3600.0;  // between epochs of a run in a new time
  static constexpr std::int64_t kMaxImuStepNs = 1'000'000'000;  // likewise, IMU
  static constexpr std::int64_t kImuLeapNs = 200'000'000;       // twice the longest IMU interval
  static constexpr double kMaxRotationRate = 35.0;    // rad/s, twice what a vehicle's IMU measures
  static constexpr double kMaxSpecificForce = 500.0;  // m/s^2
  static constexpr std::int64_t kMaxImuIntervalNs = 100'000'000;
  static constexpr int kImuRunToRestart = 20;
  static constexpr int kEpochRunToRestart = 5;

  Sequencer(const NavigatorConfig& config, StageInputs* stages);

  // None of these allocates or throws.
  void on_imu(const ImuSample& sample);
  void on_raw_epoch(const RawEpoch& epoch);
  void on_odometer(const OdometerIncrement& increment);
  void on_ephemeris(const Ephemeris& ephemeris);
  void on_precise_states(const PreciseStates& states);  // the good ones among them
  void on_klobuchar(const KlobucharModel& model);
  void on_antenna(const AntennaPattern& pattern);
  void on_command(const Command& command);
  void on_checkpoint(const Checkpoint& checkpoint);
  // A message that could not be decoded or failed validation before it got here.
  void on_rejected(InputFault fault);

  struct Counters {
    std::uint64_t imu = 0, epochs = 0, ephemerides = 0, empty_epochs = 0, late_epochs = 0,
                  imu_gaps = 0;
    std::uint64_t epochs_without_imu = 0;           // issued before their IMU came
    std::uint64_t odometer = 0, late_odometer = 0;  // accepted; of them not used
    std::uint64_t imu_smoothed = 0;  // samples of a stream whose stamps jitter, see ImuStamps
    std::array<std::uint64_t, 16> rejected{};  // by InputFault
  };
  const Counters& counters() const { return counters_; }
  GpsTime imu_time() const { return imu_time_; }  // end of the last accepted sample; may be unset
  GpsTime odometer_time() const { return odometer_.last_time(); }  // likewise

 private:
  void watch_conventions(const ImuSample& sample, InputFault fault);
  bool leaps(const ImuSample& sample) const;
  void accept_imu(const ImuSample& received);
  InputFault place_imu(ImuSample* sample);
  void change_time_base(double jump_s);
  void push_command(const Command& command);
  void extend_tail(const ImuSample& sample);
  bool gnss_keeps_time() const { return !inertial_ || !imu_time_.is_set(); }
  void place_epoch(const RawEpoch& epoch);
  bool hold(const RawEpoch& epoch);
  void judge_held(GpsTime next);
  void drop_late(GpsTime time);
  InputFault check_epoch_time(GpsTime time);
  bool is_known(GpsTime time) const;
  void queue_epoch(const RawEpoch& epoch);
  void issue_ready_epochs();
  bool waited_long_enough() const;
  void issue_oldest_pending();
  GpsTime cut_of_full_block() const;
  GpsTime time_of_due_empty_epoch() const;  // unset: none is due
  void issue(const RawEpoch* raw, GpsTime time);
  void reject(InputFault fault);
  void tell(const ConventionFinding& finding);
  void emit(EventKind kind, std::uint8_t code, double value);
  GpsTime newest_epoch_time() const;

  NavigatorConfig config_;
  StageInputs* stages_;
  bool inertial_;
  Eigen::Matrix3d C_b_imu_;  // IMU axes to body
  bool mounting_is_identity_;
  std::int64_t imu_offset_ns_;  // to be added to the IMU's stamps
  std::int64_t epoch_interval_ns_, max_epoch_ahead_ns_;
  std::int64_t gnss_wait_ns_;  // for an epoch after its time
  Counters counters_;
  GpsTime imu_time_;             // end of the last accepted sample
  GpsTime last_epoch_time_;      // t of the last issued epoch, or where the IMU stream began
  GpsTime last_raw_epoch_time_;  // t of the last issued epoch that was not empty
  bool last_epoch_is_empty_ = true;
  std::uint64_t next_index_ = 1;
  EventNumbering events_{Stage::kSequencer};
  ImuStamps imu_stamps_;
  TimeBaseWatch imu_watch_, epoch_watch_;
  RefusedImuWatch refused_imu_;
  StampOffsetWatch stamp_offset_;
  std::array<std::unique_ptr<RawEpoch>, kMaxPendingEpochs + 1>
      pending_;  // the first pending_count_, by time
  std::size_t pending_count_ = 0;
  std::unique_ptr<RawEpoch> held_;  // see above; meaningful while is_held_
  bool is_held_ = false;
  std::optional<ImuSample> leapt_imu_;      // likewise a sample
  boost::circular_buffer<ImuSample> tail_;  // IMU since the last issued epoch
  OdometerQueue odometer_;
  std::unique_ptr<GnssWork> work_;  // too large for a thread's stack
};

}  // namespace leonav
