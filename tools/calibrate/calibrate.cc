#include "tools/calibrate/calibrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/calibrate/data_halves.h"

namespace leonav {
namespace {

constexpr double kSettledSigmas = 0.5;  // a smaller change does not count, in sigmas
// nor does a smaller one in units: 2 mm, 0.002 degrees, 2 us
constexpr double kSettledUnits = 2e-3;
constexpr double kFilterShare = 0.5;  // of a pass's time, roughly

bool counts(const Finding& finding, std::size_t i) {
  const double unit = unit_of(static_cast<Quantity>(i));
  return finding.observed[i] &&
         std::abs(finding.change[i]) >
             std::max(kSettledSigmas * finding.sigma[i], kSettledUnits * unit);
}

bool is_settled(const Finding& finding) {
  for (std::size_t i = 0; i < kQuantities; ++i)
    if (counts(finding, i)) return false;
  return true;
}

// A part of the log, as shares of its length. Orbits and clocks of the whole log are used in any
// case.
struct Part {
  double from = 0.0, to = 1.0;
};

void feed(const std::string& path, const std::string& prefix, const Part& part,
          const std::function<void(double)>& progress, CalibrationRun* run) {
  EventLogReader log(path);
  LogEvent event;
  while (log.next(&event)) {
    const double share =
        static_cast<double>(log.position_bytes()) / static_cast<double>(log.size_bytes());
    progress(share);
    const auto channel = channel_from_name(event.channel, prefix);
    if (!channel || !is_input(*channel)) continue;
    // A given heading would let it start at rest (see with_installation_states()).
    if (*channel == Channel::kCommand || *channel == Channel::kCheckpoint) continue;
    const bool inside = share >= part.from && share <= part.to;
    if (inside || is_product(*channel)) run->dispatch(*channel, event.data);
  }
}

[[noreturn]] void fail(const std::string& log, LogFault fault) {
  if (fault == LogFault::kNoAttitude)
    throw std::runtime_error(log +
                             ": the filter has found no attitude; does it hold IMU and "
                             "GNSS, and does the vehicle drive?");
  throw std::runtime_error(log +
                           ": the least squares of the whole log have no solution in numbers; "
                           "leonav-replay shows where its data are gross, and a part of the log "
                           "may do");
}

bool observes_any(const Finding& finding) {
  return std::ranges::any_of(finding.observed, [](bool observed) { return observed; });
}

}  // namespace

CalibrationResult calibrate(const DaemonConfig& config, const std::string& log,
                            const CalibrateOptions& options) {
  NavigatorConfig navigator = config.navigator;
  if (navigator.motion != MotionModel::kInertial)
    throw std::runtime_error("ekf.motion is not inertial: there is no IMU to be calibrated");
  CalibrationResult calibration;
  calibration.configured = calibration.found = installation_of(navigator);
  calibration.wheeled = navigator.vehicle.motion.constraints.non_holonomic;
  while (!calibration.settled && calibration.passes < options.max_passes) {
    const auto progress = [&](double share) {
      options.progress((calibration.passes + share) / (options.max_passes + 1));
    };
    install(calibration.found, &navigator);
    CalibrationRun run(with_installation_states(navigator, options.prior), options.prior);
    feed(
        log, config.lcm.prefix, {}, [&](double share) { progress(kFilterShare * share); }, &run);
    const LogFinding whole =
        run.solve([&](double share) { progress(kFilterShare + (1.0 - kFilterShare) * share); });
    if (whole.fault != LogFault::kNone) fail(log, whole.fault);
    calibration.last = whole.finding;
    calibration.found = improved(calibration.found, calibration.last);
    calibration.straight_s = whole.straight_s;
    calibration.used_s = whole.used_s;
    calibration.length_s = whole.length_s;
    calibration.learned = run.learned();
    calibration.converged = whole.converged;
    calibration.settled = whole.converged && is_settled(calibration.last);
    ++calibration.passes;
  }
  install(calibration.found, &navigator);
  std::array<Finding, 2> halves;
  for (std::size_t half = 0; half < 2; ++half) {
    CalibrationRun run(with_installation_states(navigator, options.prior), options.prior);
    const double from = 0.5 * static_cast<double>(half);
    const auto progress = [&](double share) {
      options.progress((options.max_passes + from + 0.5 * share) / (options.max_passes + 1));
    };
    feed(
        log, config.lcm.prefix, {from, from + 0.5},
        [&](double share) { progress(kFilterShare * share); }, &run);
    const LogFinding part =
        run.solve([&](double share) { progress(kFilterShare + (1.0 - kFilterShare) * share); });
    if (part.fault == LogFault::kNone && part.converged) halves[half] = part.finding;
  }
  // The convergence test uses the sigmas of the last pass: those of the halves would excuse
  // changes. Quantities that are withdrawn take no part.
  Finding of_pass = calibration.last;
  calibration.compared = compare_halves(halves[0], halves[1], &calibration.last);
  revert_unobserved(options.prior, calibration.configured, &calibration.last, &calibration.found);
  if (!observes_any(calibration.last))
    throw std::runtime_error(log +
                             ": tells nothing of how the IMU is built in; it takes turns and "
                             "changes of speed, with carriers or good Dopplers");
  of_pass.observed = calibration.last.observed;
  calibration.settled = calibration.converged && is_settled(of_pass);
  return calibration;
}

}  // namespace leonav
