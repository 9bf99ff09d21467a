// One run of the filter over a log, with the installation among its unknowns.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/navigator/pipeline.h"
#include "daemon/input_dispatch.h"
#include "tools/calibration/installation.h"

namespace leonav {

// 1 sigma of what is known of an installation before the log is read.
struct InstallationPrior {
  double lever_arm_m = 2.0, time_offset_s = 0.1, travel_rad = 0.1745;  // 10 degrees
  // Vehicles do not stand upright in the mean of a drive: crowned roads, loads.
  double lean_rad = 8.7e-3;  // half a degree
  // What is found must be this much better known than before.
  double observed_share = 0.2;
};

// The configuration with which lever arm, time offset and, on wheels, the direction of travel are
// estimated from what `prior` knows of them.
NavigatorConfig calibrating(NavigatorConfig config, const InstallationPrior& prior);

class CalibrationRun final : private OutputSink {
 public:
  // `config`: as calibrating() gives it.
  CalibrationRun(const NavigatorConfig& config, const InstallationPrior& prior);
  void dispatch(Channel channel, ByteSpan data) { dispatch_.dispatch(channel, data); }

  // Whether there ever was an attitude.
  bool aligned() const { return aligned_; }
  // Seconds of driving straight on, by which the lean is judged.
  double straight_s() const { return straight_s_; }
  // After the log's end.
  Finding finding() const;

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  void judge_lean(Finding* finding) const;

  // An epoch of driving straight on.
  struct Upright {
    Eigen::Matrix3d C_nb;
    double sigma_roll = 0.0;  // the filter's
  };
  InstallationPrior prior_;
  bool wheeled_;
  bool aligned_ = false;
  double straight_s_ = 0.0;
  GpsTime last_epoch_;
  std::vector<Upright> straight_;
  Pipeline pipeline_;
  InputDispatch dispatch_;
};

}  // namespace leonav
