// Sequencer brings all inputs into one total order and cuts the IMU stream at the GNSS epochs.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/installation_checks/refused_imu_monitor.h"
#include "core/installation_checks/stamp_offset_monitor.h"
#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/sequencer/internal/command_limit.h"
#include "core/navigator/sequencer/internal/empty_epoch_schedule.h"
#include "core/navigator/sequencer/internal/epoch_queue.h"
#include "core/navigator/sequencer/internal/epoch_stamps.h"
#include "core/navigator/sequencer/internal/imu_block_cutter.h"
#include "core/navigator/sequencer/internal/imu_intake.h"
#include "core/navigator/sequencer/internal/imu_silence.h"
#include "core/navigator/sequencer/internal/odometer_queue.h"

namespace leonav {

// StageInputs is the interface through which the stages take the Sequencer's work. push_* may wait
// for room but must not drop.
class StageInputs {
 public:
  virtual ~StageInputs() = default;
  // Opens the mailboxes of an epoch; called before its work is pushed to any stage.
  virtual void open_epoch(std::uint64_t index) = 0;
  virtual void push_inertial(const InertialWork& work) = 0;
  virtual void push_gnss(const GnssWork& work) = 0;
  // Takes an event of the Sequencer, with its number within this stage.
  virtual void event(const Event& event) = 0;
};

// Codes of EventKind::kCapacity from the Sequencer.
enum class SequencerCapacity : std::uint8_t {
  kPendingEpochs = 0,  // value: index of the epoch that was issued without its IMU samples
};

// Sequencer decides from the data alone, so that a replay decides the same. The rules:
// - An epoch is issued once the IMU has passed its time. Without IMU
//   (MotionModel::kConstantVelocity) it is issued at once, and nothing goes to the inertial stage.
// - An epoch whose IMU data are late waits until more than EpochQueue::kMinPending wait and the two
//   that came last are more than kMaxImuLatencyNs later, or until kMaxPendingEpochs wait. It is
//   then issued without all of its IMU data, counted, and reported as kCapacity
//   (SequencerCapacity::kPendingEpochs).
// - While the IMU is silent (ImuSilence), epochs do not wait for it. Those that wait are issued, at
//   most kMostAtOnce with each epoch that comes. The newest epoch is then the time of the data: the
//   inertial stage gets it as TimeWithoutImu, and deadlines begin at it. The first sample that
//   comes in time (ImuSilence::is_in_time) ends this; until then samples are refused.
// - An empty epoch is issued one epoch interval after the last one, when the IMU has run that
//   interval and the wait for a GNSS latency; so blocks stay bounded. After a gap in the IMU stream
//   it is issued at the gap's end. The start of the first IMU sample counts as an epoch here.
// - The wait is the configured allowance, at least half an epoch interval. An epoch that comes
//   while the empty one issued for it is still the last makes the wait longer, up to
//   EmptyEpochSchedule::kMaxGnssLatencyNs; so a steady latency costs the epochs that are under way
//   until then, and not all.
// - An epoch not later than the last issued one is late: it is counted, dropped and reported. One
//   that is only out of order takes its place among those waiting. Where no IMU keeps time,
//   EpochStamps::kRunToRestart late ones in a row, over more than kLateRunNs, are a clock that was
//   set back: everything restarts. Old epochs that are sent again look the same.
// - IMU stamps are shifted by the configured time offset before anything else is done.
// - IMU samples must be finite, in range and increasing (kTimeBackwards). A sensor that repeats its
//   values is frozen (kNotSane, FrozenImuMonitor): until they change, there is a gap. Where their
//   stamps jitter, ImuTimeline lays them end to end: increments stay, intervals change.
// - A gap in the IMU stream is reported and remains a gap. After one longer than
//   ImuIntake::kLeapNs, the first sample is held until the next one: if that is later, the gap is
//   real, else the stamp was wrong.
// - An IMU stamp more than kMaxStampAheadNs beyond everything seen (kTooFarAhead), or behind, is
//   rejected, until a run of consistent ones shows that time itself has changed. Then everything
//   restarts in the new time.
// - The same holds for epochs while the IMU keeps time, except that "too far" is three epoch
//   intervals where those are longer. While IMU samples arrive between epochs, "ahead" is counted
//   from the IMU alone, and a time that both have kept is changed only by a run of epochs longer
//   than EpochStamps::kMaxContradictionNs that keep their distance from the IMU. Where no samples
//   arrive, it is changed by more epochs than the IMU may miss without an end of the answer
//   (EpochStamps::kRunWithImu), or behind the IMU by a run longer than kMaxBacklogNs. So a burst of
//   wrong stamps between two samples costs nothing, nor does what a link held back for up to a
//   minute.
// - IMU and epochs may contradict each other, as after one clock has leapt. An epoch that fits the
//   time of the IMU confirms it. A time that is not confirmed is changed by
//   EpochStamps::kRunToRestart epochs in a row that are rejected, or by as many late ones, over
//   more than kLateRunNs, that are further from the IMU than max_imu_offset_ns(). A confirmed time
//   is changed by EpochStamps::kRunWithImu such late epochs, as after a leap by seconds. Those too
//   keep their distance from the IMU (SteadyRun). Late epochs that fit the IMU's time contradict
//   wrong ones that were issued before them. Everything restarts in the time of the epochs.
// - An IMU that epochs have contradicted is distrusted until one of its samples is accepted: then
//   it is not further than max_imu_offset_ns() from the newest epoch. It can change the time only
//   where no epoch comes for ImuIntake::kDistrustedRunNs, or for kDistrustedIntervals where that is
//   longer.
// - Where epochs have led the time away while the IMU was silent, or before its first sample, a run
//   of IMU samples so far behind them restarts everything in the time of the IMU.
// - GNSS alone keeps time where there is no IMU, none yet, or a silent one. An epoch that leaps
//   ahead then comes after an outage or has a wrong stamp. It is held until the next one: if that
//   is later, there was an outage. So an outage of any length, or an interval other than
//   configured, costs no epoch.
// - An odometer increment goes with the first epoch not earlier than its end: OdometerQueue.
class Sequencer {
 public:
  // `stages` must outlive the Sequencer.
  Sequencer(const NavigatorConfig& config, StageInputs* stages);

  // These functions accept inputs in the order in which they arrive. None allocates or throws.
  void on_imu(const ImuSample& sample);
  void on_raw_epoch(const RawEpoch& epoch);
  void on_odometer(const OdometerIncrement& increment);
  void on_ephemeris(const Ephemeris& ephemeris);
  void on_precise_states(const PreciseStates& states);      // passes on those without a fault
  void on_corrected_states(const CorrectedStates& states);  // the same
  void on_signal_biases(const SignalBiases& biases);        // the same
  void on_klobuchar(const KlobucharModel& model);
  void on_antenna(const AntennaPattern& pattern);
  void on_command(const Command& command);
  void on_checkpoint(const Checkpoint& checkpoint);
  // Counts and reports a message that was refused before it reached the Sequencer, or an element of
  // one.
  void on_rejected(InputFault fault);
  // Does the same for `count` messages that a journal counts instead of holding them. They have
  // counters and a thinning of their own, so that the journal need only tell the number at each
  // event: nothing else depends on when they came.
  void on_refused(InputFault fault, std::uint64_t count);
  // Returns whether the next refused message of this fault is reported by an event.
  bool is_refusal_due(InputFault fault) const;

  // Numbers of inputs and epochs since construction.
  struct Counters {
    std::uint64_t imu = 0, epochs = 0, ephemerides = 0, empty_epochs = 0, late_epochs = 0,
                  imu_gaps = 0;
    std::uint64_t epochs_without_imu = 0;           // issued before their IMU samples came
    std::uint64_t odometer = 0, late_odometer = 0;  // accepted; accepted but too late to be used
    std::uint64_t imu_smoothed = 0;  // samples of a stream whose stamps jitter (ImuTimeline)
    std::array<std::uint64_t, 16> rejected{};  // by InputFault
    std::array<std::uint64_t, 16> refused{};   // of on_refused(), the same
    // Of `rejected`, what came as a stream.
    std::array<std::uint64_t, 16> rejected_imu{}, rejected_epochs{}, rejected_odometer{};
  };
  const Counters& counters() const { return counters_; }
  // Returns the end of the last accepted IMU sample; may be unset.
  GpsTime imu_time() const { return imu_.time(); }
  // Returns the end of the last accepted odometer increment; may be unset.
  GpsTime odometer_time() const { return odometer_.last_time(); }

 private:
  // When silence begins, more epochs may wait than stages take at once.
  static constexpr int kMostAtOnce = 8;

  // IMU.
  void monitor_conventions(const ImuSample& sample, InputFault fault);
  void accept_imu(const ImuSample& received);
  bool lay_on_timeline(ImuSample* sample);
  void append_to_block(const ImuSample& sample);
  // Epochs.
  bool hold(const RawEpoch& epoch);
  void resolve_held_epoch(GpsTime next);
  void accept_epoch(const RawEpoch& epoch);
  void follow_epochs(double jump_s, bool against_imu);
  void drop_late(GpsTime time);
  void queue_epoch(const RawEpoch& epoch);
  void issue_ready_epochs();
  void issue_oldest_pending();
  GpsTime time_of_due_empty_epoch() const;  // unset: none is due
  void issue(const RawEpoch* raw, GpsTime time);
  void open_at_inertial_stage(const EpochWork& work);
  // All inputs.
  template <typename Input>
  void check_and_push(const Input& input);
  template <typename Inputs>
  void push_good_ones(const Inputs& inputs);
  void start_new_time(double jump_s);
  void push_command(const Command& command);
  void reject(InputFault fault);
  void reject_imu(InputFault fault);
  void reject_epoch(InputFault fault);
  void report_finding(const ConventionFinding& finding);
  void emit(EventKind kind, std::uint8_t code, double value);
  bool imu_keeps_time() const;  // else the epochs do
  GpsTime now() const;          // of the data: the IMU's, or the epochs' without one; may be unset

  NavigatorConfig config_;
  StageInputs* stages_;
  bool inertial_;
  Counters counters_;
  EventNumbering events_{Stage::kSequencer};
  ImuIntake imu_;
  ImuSilence imu_silence_;
  ImuBlockCutter imu_since_epoch_;
  EpochStamps stamps_;
  EpochQueue epochs_;
  EmptyEpochSchedule empty_epochs_;
  OdometerQueue odometer_;
  CommandLimit command_limit_;
  RefusedImuMonitor refused_imu_;
  StampOffsetMonitor stamp_offset_;
  std::uint64_t next_index_ = 1;
  GpsTime last_issue_;              // time of the data then
  GpsTime last_deadline_smoother_;  // of the epoch issued last
  std::unique_ptr<GnssWork> work_;  // too large for a thread's stack
};

}  // namespace leonav
