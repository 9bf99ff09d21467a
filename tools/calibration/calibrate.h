// From a log to how the IMU is built in: runs of the filter, each with what the one before has
// found.
#pragma once
#include <functional>
#include <string>

#include "daemon/config/daemon_config.h"
#include "tools/calibration/calibration_run.h"

namespace leonav {

struct Calibration {
  Installation configured, found;
  // Its change is what was left in the last pass, its sigma what is known: the filter's, or what
  // the log's two halves tell apart, where that is more.
  Finding last;
  int passes = 0;
  bool settled = false;  // the last pass has changed nothing that counts by the filter's sigmas
  std::array<bool, kQuantities> compared{};  // what both halves have observed
  double straight_s = 0.0;
  bool wheeled = false;
};

struct CalibrateOptions {
  InstallationPrior prior;
  int max_passes = 6;
  std::function<void(double)> progress = [](double) {};  // share of the passes allowed
};

// Throws EventLogError, and std::runtime_error where the log gives no attitude, nothing of it is
// observed, or the configuration has no IMU.
Calibration calibrate(const DaemonConfig& config, const std::string& log,
                      const CalibrateOptions& options);

}  // namespace leonav
