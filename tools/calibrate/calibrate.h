// This unit finds the installation of the IMU from a log, by smoothing the whole. Every pass starts
// with the installation that the previous one has found, until nothing changes.
#pragma once
#include <functional>
#include <string>

#include "daemon/config/daemon_config.h"
#include "tools/calibrate/calibration_run.h"

namespace leonav {

// Result of a calibration.
struct CalibrationResult {
  Installation configured, found;
  // The change is that of the last pass. The sigma is that of the least squares, or that from the
  // difference between the two halves of the log if that is larger.
  Finding last;
  int passes = 0;
  bool converged = false;  // the least squares of the last pass
  bool settled = false;    // they have, and by these sigmas changed nothing that counts
  std::array<bool, kQuantities> compared{};  // observed in both halves
  double straight_s = 0.0;
  double used_s = 0.0, length_s = 0.0;  // as LogFinding, of the last pass
  bool wheeled = false;
  LearnedSummary learned;  // of the last pass
};

struct CalibrateOptions {
  InstallationPrior prior;
  int max_passes = 6;
  std::function<void(double)> progress = [](double) {};  // gets the share of the allowed passes
};

// Calibrates from `log`. Throws EventLogError, and std::runtime_error if the log gives no attitude,
// if no quantity is observed, or if the configuration has no IMU.
CalibrationResult calibrate(const DaemonConfig& config, const std::string& log,
                            const CalibrateOptions& options);

}  // namespace leonav
