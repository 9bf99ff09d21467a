// GnssStage estimates the state at each GNSS epoch with the filter and delivers it as an anchor and
// a report.
#pragma once
#include <optional>

#include "core/filter/ekf.h"
#include "core/installation_checks/installation_monitor.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/navigator/monitors/code_combination_monitor.h"
#include "core/navigator/monitors/filter_monitor.h"
#include "core/navigator/monitors/imu_gap_monitor.h"
#include "core/navigator/monitors/satellite_fault_hypotheses.h"
#include "core/navigator/monitors/satellite_fault_monitor.h"
#include "core/navigator/stages/internal/attitude_initializer.h"
#include "core/navigator/stages/internal/epoch_reporter.h"
#include "core/navigator/stages/internal/measurement_front_end.h"
#include "core/navigator/stages/internal/pending_keyframe.h"
#include "core/navigator/stages/internal/reset_plan.h"
#include "core/navigator/stages/internal/saved_calibration.h"
#include "core/vehicle/motion_aiding.h"

namespace leonav {

// GnssStage owns the filter and everything that decides about it. It allocates when constructed,
// not after.
class GnssStage {
 public:
  // `keyframes` takes the keyframes if the smoother gives the solution, else it is nullptr. All
  // pointers must outlive the stage.
  GnssStage(const NavigatorConfig& config, TimedMailbox<Anchor>* ekf_mailbox,
            KeyframeSink* keyframes, OutputSink* sink);

  // Processes one piece of work; it allocates nothing and never throws.
  //
  // For an epoch it predicts over the block, updates with the measurements, tests the filter,
  // initializes the attitude while there is none, reports and delivers. Without IMU
  // (constant-velocity model) the mailbox is not used, and the stage publishes the solution itself,
  // because no inertial tick does so; with a smoother that stage publishes. While aligning, the
  // reported position is the antenna's, because without attitude the lever arm has no direction.
  void process(const GnssWork& work);

  // Returns the source of the filter's own solution after the last work.
  Source source() const;
  const Ekf& ekf() const { return ekf_; }
  const EphemerisStore& ephemeris_store() const { return front_end_.ephemeris_store(); }
  const AntennaPatternStore& antennas() const { return front_end_.antennas(); }

 private:
  // The progress of the current epoch.
  struct EpochState {
    bool gnss_used = false;         // satellites were used
    bool filter_updated = false;    // with the front end's measurements
    bool filter_restarted = false;  // restarted or dropped
  };

  void process_work(const EpochWork& work);
  void process_work(const Command& command);
  void process_work(const Checkpoint& checkpoint);
  template <typename SatelliteData>
  void process_work(const SatelliteData& data) {
    front_end_.add(data);
  }
  void follow_window(const EpochWork& work);
  void predict(const EpochWork& work);
  void use_measurements(const EpochWork& work);
  void start_filter(const EpochWork& work);
  void restart_after_outage(const EpochWork& work);
  void update_filter(const EpochWork& work);
  void test_satellites(const EpochWork& work, const EkfUpdateResult& update);
  void test_update(const EpochWork& work, const EkfUpdateResult& update);
  void monitor_heading(const EpochWork& work);
  void initialize_attitude(const EpochWork& work);
  void check_installation(const EpochWork& work);
  void report_solution(const EpochWork& work);
  void publish(const EpochWork& work);
  void push_keyframe(const EpochWork& work);
  void take_heading(const Command& command);
  void use_heading(const EpochWork& work);
  void set_heading(double heading, double sigma);
  void report_calibration(const std::optional<SavedCalibration::Verdict>& verdict, GpsTime time);

  // The only members that drop or restart the filter or restart its clocks.
  void apply(const FilterVerdict& verdict, GpsTime time);
  void reset(const ResetPlan& plan, GpsTime time, ResetCause cause, double value,
             const PointSolution& start = {});
  void restart_filter(const ResetPlan& plan, GpsTime time, const PointSolution& start);

  NavigatorConfig config_;
  TimedMailbox<Anchor>* mailbox_;
  KeyframeSink* keyframes_;
  bool inertial_;
  MeasurementFrontEnd front_end_;
  Ekf ekf_;
  MotionAiding motion_aiding_;
  FilterMonitor filter_monitor_;
  ImuGapMonitor imu_gaps_;
  CodeCombinationMonitor code_combination_;
  SatelliteFaultMonitor satellite_faults_;
  FaultHypotheses fault_hypotheses_;  // after the last update
  AttitudeInitializer attitude_;
  SavedCalibration calibration_;
  EpochReporter reporter_;
  PendingKeyframe pending_keyframe_;
  std::optional<Command> pending_heading_;  // which holds later than the filter's state
  InstallationMonitor installation_monitor_;
  EpochState epoch_;    // the current or last epoch
  LevelGrowth levels_;  // protection levels from that epoch on
  GpsTime last_epoch_time_;
  GpsTime last_gnss_time_;  // time of the last epoch that used satellites
};

}  // namespace leonav
