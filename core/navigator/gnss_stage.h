// Raw epoch -> measurements -> EKF -> anchor and report.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/conventions/convention_check.h"
#include "core/ekf/consistency_watch.h"
#include "core/ekf/ekf.h"
#include "core/gnss/antenna_catalog.h"
#include "core/gnss/band_bias.h"
#include "core/gnss/carrier_follower.h"
#include "core/gnss/preprocess.h"
#include "core/gnss/satellite_catalog.h"
#include "core/ins/alignment.h"
#include "core/ins/given_heading.h"
#include "core/navigator/carrier_speed.h"
#include "core/navigator/checkpoint_judge.h"
#include "core/navigator/event_source.h"
#include "core/navigator/heading_watch.h"
#include "core/navigator/keyframe_maker.h"
#include "core/navigator/lock_out_watch.h"
#include "core/navigator/motion_aid.h"
#include "core/navigator/navigator_config.h"
#include "core/navigator/orbit_watch.h"
#include "core/navigator/outage_watch.h"
#include "core/navigator/stage_work.h"
#include "core/navigator/timed_mailbox.h"
#include "core/navigator/usable_watch.h"

namespace leonav {

class GnssStage {
 public:
  // `keyframes` only where the smoother gives the answer, else nullptr.
  GnssStage(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox,
            KeyframeSink* keyframes, OutputSink* sink);

  // Allocates nothing, never throws. For an epoch: preprocess, predict over the block, update,
  // align if still needed, deliver to the mailbox, report. Without IMU (constant-velocity model) it
  // also publishes the solution itself, as there is no inertial tick to do so, and the mailbox is
  // not used; where there is a smoother, that publishes. While aligning the reported position is
  // the antenna's: without attitude the lever arm has no direction.
  void process(const GnssWork& work);

  Source source() const;  // of its own answer, after the last work
  const Ekf& ekf() const { return ekf_; }
  const SatelliteCatalog& catalog() const { return catalog_; }
  const AntennaCatalog& antennas() const { return antennas_; }

 private:
  void process_epoch(const EpochWork& work);
  void process_command(const Command& command);
  void use_measurements(const EpochWork& work);
  bool solve_beyond_doubt(const EpochWork& work, PointSolution* point);
  bool start_filter(const EpochWork& work);
  void update_filter(const EpochWork& work);
  void judge(const EpochWork& work, const EkfUpdateResult& result);
  void forget_judgements();
  void judge_prediction(const EpochWork& work, const EkfUpdateResult& result);
  void judge_position(const EpochWork& work, const EkfUpdateResult& result);
  void judge_lock_out(const EpochWork& work, const EkfUpdateResult& result);
  bool prediction_is_useless() const;
  double position_sigma() const;
  Eigen::Vector3d approximate_position(const EpochWork& work);
  PreprocessAids aids();
  RangeChangePrior change_prior(bool predicted) const;
  void drop_broken_filter(GpsTime time);
  void drop_filter(GpsTime time, ResetCause cause, double value);
  void watch_consistency(const EpochWork& work, const EkfUpdateResult& result);
  OutageWatch::Position antenna_position() const;
  void watch_outage(const OutageWatch::Position& before, GpsTime time);
  void watch_clocks(const EkfUpdateResult& result, GpsTime time);
  void watch_usable();
  bool contradicts(const PointSolution& point, GpsTime time, bool motion) const;
  bool has_moved_as(const PointSolution& point, GpsTime time) const;
  bool solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e, PointSolution* point) {
    return solve(work, approximate_p_e, &band_biases_, point);
  }
  bool solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e, BandBiases* biases,
             PointSolution* point);
  void restart_from(const PointSolution& point, const EpochWork& work, ResetCause cause);
  void watch_motion(const EpochWork& work);
  double velocity_sigma() const;
  AlignmentNeed alignment_need() const;
  double gyro_bias_sigma() const;
  void start_heading_watch();
  void watch_heading(const EpochWork& work);
  void align(const EpochWork& work);
  void set_heading(double heading, double sigma);
  void take_checkpoint(const Checkpoint& checkpoint);
  void judge_checkpoint(GpsTime time);
  void tell(const CheckpointJudge::Verdict& verdict, GpsTime time);
  std::optional<Checkpoint> checkpoint(const EpochWork& work) const;
  void report_solution(const EpochWork& work);
  void deliver(const EpochWork& work);
  void push_keyframe(const EpochWork& work);
  void publish(const EpochWork& work);
  void watch_orbits();
  void check_conventions(const EpochWork& work);

  NavigatorConfig config_;
  TimedMailbox<EkfUpdate>* mailbox_;
  KeyframeSink* keyframes_;
  OutputSink* sink_;
  EventSource events_;
  bool inertial_;
  SatelliteCatalog catalog_;
  AntennaCatalog antennas_;
  BandBiases band_biases_;
  CarrierFollower carriers_;
  Eigen::Matrix3d C_er_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d last_position_covariance_ = Eigen::Matrix3d::Zero();  // after the last update
  Ekf ekf_;
  MotionAid motion_aid_;
  CarrierSpeed carrier_speed_;
  Alignment alignment_;
  GivenHeading given_heading_;
  HeadingWatch heading_watch_;
  CheckpointJudge checkpoint_judge_;
  std::unique_ptr<MeasurementEpoch> measurements_;
  std::unique_ptr<MeasurementEpoch> check_measurements_;  // of a point solution beside the filter
  std::unique_ptr<EpochReport> report_;
  std::uint64_t next_report_ = 1, next_solution_ = 1;
  std::array<ConsistencyWatch, 2> consistency_;  // codes, Dopplers
  OrbitWatch orbit_watch_;
  UsableWatch usable_watch_;
  LockOutWatch lock_out_watch_;
  OutageWatch outage_watch_;
  std::uint64_t clock_steps_ = 0;
  std::array<std::uint64_t, 5> orbit_changes_{};  // per OrbitChange
  int suspect_epochs_ = 0;
  GpsTime suspect_since_;  // the first of them, if codes had a position for it
  PointSolution suspect_point_;
  bool gnss_used_ = false;  // in the epoch at hand
  bool updated_ = false;    // likewise: the filter has had measurements_
  GpsTime last_gnss_time_;  // of the last epoch that used any
  GpsTime last_reset_time_;
  GpsTime last_lock_out_;
  GpsTime last_judged_;
  double elsewhere_ = 0.0;  // what codes say for another place, less what they have said for this
  Eigen::Vector3d mean_off_e_ = Eigen::Vector3d::Zero();
  GpsTime last_epoch_time_;
  KeyframeMaker keyframe_maker_;
  ConventionCheck convention_check_;
  std::uint64_t next_decision_ = 1;
};

}  // namespace leonav
