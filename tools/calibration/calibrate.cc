#include "tools/calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"

namespace leonav {
namespace {

constexpr double kSettledSigmas = 0.2;  // a change that does not count,
constexpr double kSettledUnits = 2e-3;  // nor does this: 2 mm, 0.002 degrees, 2 us

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

void feed(const std::string& path, const std::string& prefix,
          const std::function<void(double)>& progress, CalibrationRun* run) {
  EventLogReader log(path);
  LogEvent event;
  while (log.next(&event)) {
    progress(static_cast<double>(log.position_bytes()) / static_cast<double>(log.size_bytes()));
    const auto channel = channel_from_name(event.channel, prefix);
    if (channel && is_input(*channel)) run->dispatch(*channel, event.data);
  }
}

}  // namespace

Calibration calibrate(const DaemonConfig& config, const std::string& log,
                      const CalibrateOptions& options) {
  NavigatorConfig navigator = config.navigator;
  if (navigator.motion != MotionModel::kInertial)
    throw std::runtime_error("ekf.motion is not inertial: there is no IMU to be calibrated");
  Calibration calibration;
  calibration.configured = calibration.found = installation_of(navigator);
  calibration.wheeled = navigator.vehicle.motion.constraints.non_holonomic;
  while (!calibration.settled && calibration.passes < options.max_passes) {
    install(calibration.found, &navigator);
    CalibrationRun run(calibrating(navigator, options.prior), options.prior);
    const auto progress = [&](double share) {
      options.progress((calibration.passes + share) / options.max_passes);
    };
    feed(log, config.lcm.prefix, progress, &run);
    if (!run.aligned())
      throw std::runtime_error(log +
                               ": the filter has found no attitude; does it hold IMU and "
                               "GNSS, and does the vehicle drive?");
    calibration.last = run.finding();
    calibration.found = improved(calibration.found, calibration.last);
    calibration.straight_s = run.straight_s();
    calibration.settled = is_settled(calibration.last);
    ++calibration.passes;
  }
  return calibration;
}

}  // namespace leonav
