// leonav-synthetic-drive: the tests' synthetic drive as a log and a truth file.
#include <algorithm>
#include <iostream>

#include "drivers/csv/truth_csv.h"
#include "support/drive/synthetic_drive.h"
#include "tools/common/arguments.h"
#include "tools/import/log_output.h"

namespace {

leonav::TruthPoint to_truth_point(const leonav::NavState& state) {
  leonav::TruthPoint point;
  point.time = state.time;
  point.position = leonav::to_geodetic(state.p_e);
  const Eigen::Matrix3d C_ne = leonav::rotation_ecef_to_ned(point.position);
  point.v_n = C_ne * state.v_e;
  const leonav::EulerAngles angles =
      leonav::euler_from_rotation(C_ne * state.q_eb.toRotationMatrix());
  point.roll = angles.roll;
  point.pitch = angles.pitch;
  point.yaw = angles.yaw;
  return point;
}

// Noise of a tactical IMU and of an open-sky receiver.
leonav::test::SyntheticDriveOptions noisy(double duration_s, double seed) {
  leonav::test::SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.seed = static_cast<std::uint64_t>(seed);
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.05;
  options.angle_random_walk = 1.5e-5;                // 0.05 deg/sqrt(h)
  options.velocity_random_walk = 1.7e-3;             // 0.1 m/s/sqrt(h)
  options.gyro_bias_b = {2.4e-6, -2.4e-6, 2.4e-6};   // 0.5 deg/h
  options.accel_bias_b = {2.5e-4, -2.5e-4, 2.5e-4};  // 25 mGal
  return options;
}

int body(int argc, char** argv) {
  leonav::Arguments arguments("leonav-synthetic-drive", "--out run.lcmlog --truth truth.csv",
                              "Writes a synthetic drive (figures of eight under GPS and Galileo, "
                              "open sky; --full-sky: three systems) as an LCM log with its "
                              "truth.");
  arguments.option("--out", "FILE", "the log")
      .option("--truth", "FILE", "truth.csv, ten rows per second")
      .option("--duration", "S", "length, 60 to 3600", "300")
      .option("--seed", "N", "of the noise", "1")
      .flag("--full-sky", "with BeiDou, where 32 satellites are above 15 degrees")
      .flag("--carriers", "carrier phases too, with a noise of 2 mm")
      .option("--slips", "SHARE",
              "share of a satellite's epochs at which its carriers slip, 0 to 1", "0");
  if (!arguments.parse(argc, argv)) return 0;
  const double duration_s = arguments.number("--duration");
  if (!(duration_s >= 60.0 && duration_s <= 3600.0)) {
    throw leonav::UsageError("--duration must be 60 to 3600");
  }
  const double seed = arguments.number("--seed");
  if (!(seed >= 0.0 && seed < 1e15)) throw leonav::UsageError("--seed must be 0 to 1e15");
  const std::string out = arguments.required("--out"), truth_path = arguments.required("--truth");
  auto options = noisy(duration_s, seed);
  if (arguments.has("--full-sky")) options = leonav::test::full_sky(options);
  if (arguments.has("--carriers")) options.carrier_sigma_m = 0.002;
  options.slip_probability = arguments.number("--slips");
  if (!(options.slip_probability >= 0.0 && options.slip_probability <= 1.0)) {
    throw leonav::UsageError("--slips must be 0 to 1");
  }
  if (options.slip_probability > 0.0 && !arguments.has("--carriers")) {
    throw leonav::UsageError("--slips needs --carriers");
  }
  const auto drive = leonav::test::synthetic_drive(options);

  leonav::ImportReport report;
  leonav::LogOutput log(out, &report);
  leonav::GpsTime now = drive.imu.front().time;
  leonav::test::feed(
      drive, 0.05, [&](const leonav::Ephemeris& ephemeris) { log.write(now, ephemeris); },
      [&](const leonav::ImuSample& sample) { log.write(now = sample.time, sample); },
      [&](const leonav::RawEpoch& epoch) { log.write(now, epoch); });
  log.commit();

  std::vector<leonav::TruthPoint> truth;
  const auto stride = static_cast<std::size_t>(drive.options.imu_rate_hz / 10.0);
  for (std::size_t i = 0; i < drive.truth.size(); i += stride) {
    truth.push_back(to_truth_point(drive.truth[i]));
  }
  leonav::write_truth_csv(truth_path, truth);
  std::cout << out << ": synthetic drive\n" << leonav::to_string(report);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return leonav::run_tool("leonav-synthetic-drive", body, argc, argv);
}
