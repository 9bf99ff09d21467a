// GnssStage estimates the state at each GNSS epoch with the filter and delivers it as an anchor and
// a report.
#pragma once
#include "core/filter/ekf.h"
#include "core/installation_checks/installation_monitor.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"
#include "core/navigator/monitors/filter_monitor.h"
#include "core/navigator/stages/internal/attitude_initializer.h"
#include "core/navigator/stages/internal/epoch_reporter.h"
#include "core/navigator/stages/internal/measurement_front_end.h"
#include "core/navigator/stages/internal/pending_keyframe.h"
#include "core/navigator/stages/internal/reset_plan.h"
#include "core/vehicle/motion_aiding.h"

namespace leonav {

class GnssStage {
 public:
  // `keyframes` only where the smoother gives the answer, else nullptr.
  GnssStage(const NavigatorConfig& config, TimedMailbox<Anchor>* ekf_mailbox,
            KeyframeSink* keyframes, OutputSink* sink);

  // Processes one piece of work. An epoch: predict over its block, update with its measurements,
  // test the filter, initialize the attitude while there is none, report, deliver. Without IMU
  // (constant-velocity model) the stage also publishes the solution, because no inertial tick does
  // so, and the mailbox is not used; where there is a smoother, that publishes. While aligning, the
  // reported position is the antenna's: without attitude the lever arm has no direction. Allocates
  // nothing, never throws.
  void process(const GnssWork& work);

  Source source() const;  // of the filter's own answer, after the last work
  const Ekf& ekf() const { return ekf_; }
  const EphemerisStore& ephemeris_store() const { return front_end_.ephemeris_store(); }
  const AntennaPatternStore& antennas() const { return front_end_.antennas(); }

 private:
  struct EpochState {
    bool gnss_used = false;
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
  void predict(const EpochWork& work);
  void use_measurements(const EpochWork& work);
  void start_filter(const EpochWork& work);
  void restart_after_outage(const EpochWork& work);
  void update_filter(const EpochWork& work);
  void test_update(const EpochWork& work, const EkfUpdateResult& update);
  void monitor_heading(const EpochWork& work);
  void initialize_attitude(const EpochWork& work);
  void check_installation(const EpochWork& work);
  void report_solution(const EpochWork& work);
  void publish(const EpochWork& work);
  void push_keyframe(const EpochWork& work);
  void set_heading(double heading, double sigma);

  // The only members that drop, restart or re-clock the filter.
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
  AttitudeInitializer attitude_;
  EpochReporter reporter_;
  PendingKeyframe pending_keyframe_;
  InstallationMonitor installation_monitor_;
  EpochState epoch_;  // of the last epoch
  GpsTime last_epoch_time_;
  GpsTime last_gnss_time_;  // of the last epoch that used satellites
};

}  // namespace leonav
