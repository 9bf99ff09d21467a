// CalibrationRun runs the filter over a log with the installation among its states.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/messages/input_dispatch.h"
#include "tools/calibrate/installation.h"

namespace leonav {

// 1 sigma of the knowledge of an installation before the log is read.
struct InstallationPrior {
  double lever_arm_m = 2.0, time_offset_s = 0.1, travel_rad = 0.1745;  // 10 degrees
  // Vehicles do not stand upright in the mean of a drive: crowned roads, loads. rad, half a degree.
  double lean_rad = 8.7e-3;
  // A quantity counts as observed if its sigma has fallen below this share of the prior.
  double observed_share = 0.2;
};

// Returns the configuration in which lever arm, time offset and, on wheels, the direction of travel
// are states with the prior `prior`.
NavigatorConfig with_installation_states(NavigatorConfig config, const InstallationPrior& prior);

// CalibrationRun is fed with a log's messages and then gives the finding.
class CalibrationRun final : private OutputSink {
 public:
  // `config` comes from with_installation_states().
  CalibrationRun(const NavigatorConfig& config, const InstallationPrior& prior);
  void dispatch(Channel channel, ByteSpan data) { dispatch_.dispatch(channel, data); }

  // Returns whether there was ever an attitude.
  bool aligned() const { return aligned_; }
  // Returns the seconds of straight driving from which the lean is estimated.
  double straight_s() const { return straight_s_; }
  // Returns the mean of what the filter has learned about the errors of codes and Dopplers.
  const LearnedSummary& learned() const { return learned_; }
  // Returns the result after the end of the log.
  Finding finding() const;

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  void add_learned(const LearnedSummary& errors);
  void estimate_lean(Finding* finding) const;

  // An epoch of straight driving.
  struct StraightEpoch {
    Eigen::Matrix3d C_nb;
    double sigma_roll = 0.0;  // rad, 1 sigma of the filter
  };
  InstallationPrior prior_;
  bool wheeled_;
  bool aligned_ = false;
  double straight_s_ = 0.0;
  GpsTime last_epoch_;
  std::vector<StraightEpoch> straight_;
  LearnedSummary learned_;
  int learned_epochs_ = 0;
  Navigator navigator_;
  InputDispatch dispatch_;
};

}  // namespace leonav
