#include "core/navigator/pipeline.h"

#include <iostream>

#include "recording_sink.h"
#include "support/catch.h"
#include "support/synthetic_drive.h"

namespace leonav::test {
namespace {

NavigatorConfig test_config(const SyntheticDriveOptions& options) {
  NavigatorConfig config;
  config.gnss = default_gnss_config();
  for (SystemConfig& system : config.gnss.systems) system.enabled = true;
  config.vehicle.lever_arm_b = options.lever_arm_b;
  config.imu.angle_random_walk = 1e-4;
  config.imu.velocity_random_walk = 1e-3;
  config.imu.gyro_bias = {1e-4, 3600.0};
  config.imu.accel_bias = {0.01, 3600.0};
  config.imu.gyro_scale = {1e-4, 3600.0};
  config.imu.accel_scale = {1e-4, 3600.0};
  return config;
}

void run(const SyntheticDrive& drive, double latency_s, Pipeline* pipeline) {
  Sequencer& sequencer = pipeline->sequencer();
  feed(
      drive, latency_s, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
      [&](const ImuSample& s) { sequencer.on_imu(s); },
      [&](const RawEpoch& r) { sequencer.on_raw_epoch(r); });
}

TEST_CASE("the whole pipeline finds the truth of a synthetic drive") {
  SyntheticDriveOptions options;
  options.duration_s = 90.0;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Pipeline pipeline(test_config(options), &sink);
  run(drive, 0.06, &pipeline);
  REQUIRE(sink.epochs.size() >= 89);
  REQUIRE(!sink.solutions.empty());
  double worst = 0, worst_v = 0, worst_yaw = 0;
  int n = 0;
  for (const Solution& s : sink.solutions) {
    const NavState truth = drive.truth_at(s.time);
    if (seconds_between(s.time, kSkyEpoch) < 40 || !s.has_attitude) continue;
    ++n;
    worst = std::max(worst, (s.p_e - truth.p_e).norm());
    const Eigen::Matrix3d C_ne = rotation_ecef_to_ned({s.latitude, s.longitude, s.height});
    worst_v = std::max(worst_v, (s.v_n - C_ne * truth.v_e).norm());
    const double yaw = euler_from_rotation(C_ne * truth.q_eb.toRotationMatrix()).yaw;
    worst_yaw = std::max(worst_yaw, std::abs(wrap_to_pi(s.yaw - yaw)));
  }
  std::cout << "solutions " << n << " worst p " << worst << " v " << worst_v << " yaw " << worst_yaw
            << "\n";
  for (const Event& e : sink.events)
    std::cout << "event " << to_string(e.kind) << " " << int(e.code) << " " << e.value << " at "
              << seconds_between(e.time, kSkyEpoch) << "\n";
  for (std::size_t i = 0; i < sink.epochs.size(); i += 10) {
    const auto& e = sink.epochs[i];
    std::cout << "epoch " << e.index << " used " << e.satellites_used << " of "
              << e.satellites.size() << " pdop " << e.pdop << " nis " << e.nis << "/"
              << e.nis_degrees << " src " << to_string(e.solution.source) << " sigma "
              << e.solution.sigma_p_n.transpose() << " err "
              << (e.solution.p_e - drive.truth_at(e.time).p_e).norm() << "\n";
  }
  CHECK(n > 9000);
  CHECK(worst < 0.5);
}

}  // namespace
}  // namespace leonav::test
