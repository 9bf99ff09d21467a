// A synthetic drive as the messages that a live system would receive.
#pragma once
#include <cstdint>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "support/drive/synthetic_drive.h"

namespace leonav::test {

inline constexpr double kEpochLatencyS = 0.06;

struct Input {
  Channel channel;
  std::vector<std::uint8_t> bytes;
};

// Calls use(channel, bytes) in the order of receipt; `bytes` are valid during the call.
template <typename Use>
void feed_messages(const SyntheticDrive& drive, Use use) {
  Encoder encoder;
  std::uint64_t ephemerides = 0, samples = 0, epochs = 0;
  feed(
      drive, kEpochLatencyS,
      [&](const Ephemeris& e) { use(Channel::kEphemeris, encoder.encode(e, ++ephemerides)); },
      [&](const ImuSample& s) { use(Channel::kImu, encoder.encode(s, ++samples)); },
      [&](const RawEpoch& e) { use(Channel::kGnssEpoch, encoder.encode(e, ++epochs)); });
}

inline SyntheticDriveOptions noisy_drive(double duration_s) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.slip_probability = 0.002;
  return with_noise(options, 0.5);
}

// For noisy_drive(), without what needs rights.
inline DaemonConfig drive_config() {
  DaemonConfig config;
  config.navigator.gnss = default_gnss_config();
  config.navigator.vehicle.lever_arm_b = SyntheticDriveOptions().lever_arm_b;
  config.navigator.imu = {1e-4, 1e-3, {1e-3, 1000.0}, {1e-2, 1000.0}, {1e-3, 1e4}, {1e-3, 1e4}};
  config.navigator.ekf.use_carrier = true;
  config.navigator.ekf.wet_delay_sigma_m = 0.1;
  config.threads.lock_memory = false;
  config.journal.buffer_mb = 64.0;  // messages come much faster than from sensors
  return config;
}

}  // namespace leonav::test
