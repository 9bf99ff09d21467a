// CalibrationRun smooths a log with the installation among its states.
#pragma once
#include <cstdint>
#include <functional>

#include "core/smoother/batch/log_graph.h"
#include "tools/calibrate/installation.h"
#include "tools/smooth/keyframe_collector.h"

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

// Why a log tells nothing of an installation.
enum class LogFault : std::uint8_t {
  kNone = 0,
  kNoAttitude,  // the filter has found none
  kNoSolution,  // the least squares have no solution in numbers
};

// What a log tells of an installation.
struct LogFinding {
  LogFault fault = LogFault::kNone;  // otherwise nothing else is set
  Finding finding;
  bool converged = false;   // the last iteration of the least squares hardly moved anything
  double straight_s = 0.0;  // of straight driving, from which the lean is estimated
  // Where the filter starts over the constants begin anew: those found are of the last used_s
  // seconds of length_s with an attitude.
  double used_s = 0.0, length_s = 0.0;
};

// CalibrationRun is fed with a log's messages. Then all epochs of the log are one least-squares
// problem, in which the installation is constant.
class CalibrationRun {
 public:
  // `config` comes from with_installation_states().
  CalibrationRun(const NavigatorConfig& config, const InstallationPrior& prior);
  void dispatch(Channel channel, ByteSpan data) { collector_.dispatch(channel, data); }

  // Solves after the end of the log; `progress` gets the share done.
  LogFinding solve(const std::function<void(double)>& progress);
  // Returns the mean of what the filter has learned about the errors of codes and Dopplers.
  const LearnedSummary& learned() const { return learned_; }

 private:
  void add_learned(const LearnedSummary& errors);

  NavigatorConfig config_;
  InstallationPrior prior_;
  LearnedSummary learned_;
  int learned_epochs_ = 0;
  LogGraph graph_;
  KeyframeCollector collector_;
};

}  // namespace leonav
