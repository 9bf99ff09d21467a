// A synthetic drive, smoothed as leonav-smooth does it, with its truth.
#pragma once
#include "core/smoother/batch/batch_smoother.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/drive/navigator_config.h"
#include "tools/smooth/keyframe_collector.h"

namespace leonav::test {

inline SyntheticDriveOptions smoothed_options() {
  SyntheticDriveOptions options = noisy_drive(60.0);
  options.imu_rate_hz = 100.0;
  options.angle_random_walk = 1e-5;
  options.velocity_random_walk = 1e-4;
  return options;
}

// It stands for ten seconds, without an attitude in the filter, and then drives.
struct SmoothedDrive {
  SmoothedDrive() : drive(synthetic_drive(smoothed_options())), graph(drive.options.lever_arm_b) {
    NavigatorConfig config = drive_navigator_config(drive.options);
    config.ekf.use_carrier = true;
    KeyframeCollector collector(config, &graph);
    feed_messages(drive,
                  [&](Channel channel, ByteSpan bytes) { collector.dispatch(channel, bytes); });
    counts = collector.counts();
    LogProcesses processes({config.ekf, config.imu, config.vehicle.motion.constraints});
    BatchConfig batch;
    batch.robust = config.ekf.robust;
    result = smooth(
        batch, nullptr, &processes, [](int, double) {}, &graph);
  }

  SyntheticDrive drive;
  LogGraph graph;
  PassCounts counts;
  BatchResult result;
};

// Made once, because it takes seconds.
inline const SmoothedDrive& smoothed_drive() {
  static const SmoothedDrive smoothed;
  REQUIRE(smoothed.result.converged);
  return smoothed;
}

}  // namespace leonav::test
