// These functions simulate a wheel's odometer along a synthetic drive and feed both into a
// Navigator.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/drive/stage_drive.h"

namespace leonav::test {

// The simulated wheel and its counter.
struct WheelOptions {
  double rate_hz = 10.0;
  double scale_error = 0.015;  // relative error of the counted distance
  double resolution_m = 0.05;  // distance per pulse
  double phase_s = 0.0;        // shift of the increments' ends
  bool sign_known = true;
  double lock_from_s = 1e9, lock_to_s = 1e9;  // interval in which the wheel does not turn
};

// Returns the odometer increments of the wheel along `drive`.
inline std::vector<OdometerIncrement> wheel_of(const SyntheticDriveOptions& drive,
                                               const WheelOptions& options = {}) {
  const SyntheticPath path(drive);
  std::vector<OdometerIncrement> increments;
  double rolled_m = 0.0, counted_m = 0.0;
  const double interval_s = 1.0 / options.rate_hz;
  for (double end_s = options.phase_s + interval_s; end_s < drive.duration_s; end_s += interval_s) {
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
      const double t = end_s - interval_s * (1.0 - (i + 0.5) / kSteps);
      if (t > options.lock_from_s && t < options.lock_to_s) continue;
      rolled_m += (1.0 + options.scale_error) * path.state(t).v_e.norm() * interval_s / kSteps;
    }
    const double whole_m = std::floor(rolled_m / options.resolution_m) * options.resolution_m;
    increments.push_back({kSkyEpoch.plus_seconds(end_s), std::llround(interval_s * 1e9),
                          whole_m - counted_m, options.sign_known});
    counted_m = whole_m;
  }
  return increments;
}

// Feeds the drive and the increments, each `late_s` after its end by the IMU's time. Allocates
// nothing.
inline void feed_with_wheel(const SyntheticDrive& drive,
                            const std::vector<OdometerIncrement>& wheel, double late_s,
                            Navigator* pipeline) {
  Sequencer& sequencer = pipeline->sequencer();
  std::size_t next = 0;
  feed(
      drive, 0.06, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
      [&](const ImuSample& s) {
        sequencer.on_imu(s);
        while (next < wheel.size() && wheel[next].time.plus_seconds(late_s) <= s.time)
          sequencer.on_odometer(wheel[next++]);
      },
      [&](const RawEpoch& raw) { sequencer.on_raw_epoch(raw); });
}

}  // namespace leonav::test
