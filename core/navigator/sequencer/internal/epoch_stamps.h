// EpochStamps decides from the stamps of epochs whether these and the IMU keep the same time.
#pragma once
#include <cstdint>

#include "core/navigator/sequencer/internal/stamp_decision.h"
#include "core/navigator/sequencer/internal/steady_run.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// In every function `imu_time` is the end of the last accepted IMU sample, and unset where the IMU
// does not keep the time.
class EpochStamps {
 public:
  // An epoch may be this many epoch intervals ahead, where that is more than kMaxStampAheadNs.
  static constexpr double kMaxAheadIntervals = 3.0;
  static constexpr double kMaxStepS = 3600.0;  // longest interval in a run of epochs in a new time
  static constexpr int kRunToRestart = 5;      // epochs that must agree on a new time
  // Where the IMU has kept time, a run must be longer than the silence of the IMU over which the
  // inertial answer goes on: at least so many epochs, and more than such a silence has.
  static constexpr int kRunWithImu = 12;
  static constexpr std::int64_t kImuSilenceNs = 10'000'000'000;
  // A steady run (SteadyRun) longer than this contradicts a confirmed IMU although its samples
  // come. It is mostly GNSS that is wrong then; but the inertial answer is of no use for longer.
  static constexpr std::int64_t kMaxContradictionNs = 300'000'000'000;
  // A run behind a confirmed IMU whose samples do not come contradicts it if longer than this: what
  // a link held back while it stalled comes at once, and is behind as well.
  static constexpr std::int64_t kMaxBacklogNs = 60'000'000'000;
  // How long a run of late epochs must be before it contradicts the time they are late in.
  static constexpr std::int64_t kLateRunNs = 3'000'000'000;

  explicit EpochStamps(double epoch_interval_s);

  // Returns how far an epoch may lie ahead of everything seen, ns.
  std::int64_t max_ahead_ns() const { return max_ahead_ns_; }
  // Returns by how much IMU and newest epoch differ at most while both are right: GNSS may be late,
  // and the next epoch is an interval away.
  std::int64_t max_imu_offset_ns() const { return max_imu_offset_ns_; }
  // Returns whether an IMU sample and an epoch are further apart than max_imu_offset_ns().
  bool are_apart(GpsTime imu_time, GpsTime epoch) const;
  // Returns whether the stamp is so much later than the newest epoch, which may be unset, that it
  // is wrong or follows an outage.
  bool leaps(GpsTime time, GpsTime newest_epoch) const;

  // Decides whether the stamp of an epoch fits. `newest_epoch` may be unset. A late epoch passes
  // here. While no epoch has confirmed the IMU's time, kRunToRestart epochs suffice to contradict
  // it: those that are rejected, and then those that are older than the newest one by more than
  // max_imu_offset_ns().
  StampDecision evaluate(GpsTime time, GpsTime imu_time, GpsTime newest_epoch);
  // Adds a late epoch to the run of late ones, and returns whether these show that the time in
  // which they are late is wrong. Epochs from which the IMU is too far contradict it: if an epoch
  // has confirmed its time, as many as change the time while it is silent. Those that fit it
  // contradict wrong epochs, later ones, which were issued before: `last_issued` is the time of
  // the last epoch that was issued and not empty; may be unset.
  bool add_late(GpsTime time, GpsTime imu_time, GpsTime last_issued);
  // Records that an epoch has fitted; with `imu_keeps_time` it confirms the time of the IMU, until
  // the next time step.
  void add_good(bool imu_keeps_time);
  // Records an accepted IMU sample. It ends the run of rejected epochs that would contradict a
  // confirmed time while no samples come.
  void add_imu_sample();
  bool confirms_imu() const { return confirms_imu_; }

  // Forgets all stamps, after a time step.
  void clear();

 private:
  void end_runs();

  std::int64_t max_ahead_ns_, max_imu_offset_ns_;
  int run_with_imu_;
  TimeStepMonitor rejected_, late_;        // runs of epochs; late_: of those that fit the IMU
  SteadyRun far_from_imu_, late_for_imu_;  // rejected ones, late ones
  GpsTime imu_time_at_last_;               // at the last evaluate()
  bool confirms_imu_ = false;
};

}  // namespace leonav
