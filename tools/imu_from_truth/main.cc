// leonav-imu-from-truth makes a semi-real IMU file from a recorded track of positions.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <vector>

#include "core/base/angle.h"
#include "drivers/csv/imu_csv.h"
#include "drivers/csv/truth_csv.h"
#include "tools/common/arguments.h"
#include "tools/sim/motion/ideal_imu.h"
#include "tools/sim/motion/sensor_errors.h"
#include "tools/sim/motion/smooth_track.h"

namespace {

using leonav::Arguments;
using leonav::kDegree;
using leonav::UsageError;

constexpr char kName[] = "leonav-imu-from-truth";

Arguments declare() {
  Arguments arguments(
      kName, "--truth truth.csv --out imu.csv [options]",
      "Makes the IMU file a sensor would have written on a recorded track of positions: smooths\n"
      "the track, points the nose along the course (held at standstill), adds the errors of a\n"
      "data sheet (default: the POS320 class). Same seed, same file. The result is semi-real:\n"
      "real motion, invented sensor.");
  arguments.option("--truth", "FILE", "truth.csv with positions, 5 Hz or more")
      .option("--out", "FILE", "imu.csv to write")
      .option("--truth-out", "FILE", "write the smoothed truth, with velocity and attitude")
      .option("--rate", "HZ", "IMU rate, 10 to 1000", "100")
      .option("--gyro-bias-deg-per-h", "X", "1 sigma, drifting over an hour", "0.5")
      .option("--accel-bias-mgal", "X", "1 sigma, drifting over an hour", "25")
      .option("--gyro-scale-ppm", "X", "1 sigma, constant", "0")
      .option("--accel-scale-ppm", "X", "1 sigma, constant", "0")
      .option("--angle-random-walk-deg-per-sqrt-h", "X", "gyro noise", "0.05")
      .option("--velocity-random-walk-m-s-per-sqrt-h", "X", "accelerometer noise", "0.1")
      .option("--seed", "N", "of the sensor errors", "1")
      .flag("--ideal", "no sensor errors at all")
      .option("--smoothing-hz", "HZ", "faster motion of the truth counts as its noise", "1")
      .option("--max-gap", "S", "a wider hole in the truth is an error", "2");
  return arguments;
}

// Returns the number of an option after testing its range.
double in_range(const Arguments& arguments, const std::string& name, double low, double high) {
  const double value = arguments.number(name);
  if (!(value >= low && value <= high)) {
    throw UsageError(name + " must be within " + std::to_string(low) + " to " +
                     std::to_string(high) + ", not " + arguments.get(name));
  }
  return value;
}

leonav::ImuErrorModel error_model(const Arguments& arguments) {
  constexpr double kHour = 3600.0, kMilligal = 1e-5, kPpm = 1e-6;
  leonav::ImuErrorModel model;
  model.gyro_bias.sigma = in_range(arguments, "--gyro-bias-deg-per-h", 0.0, 1e5) * kDegree / kHour;
  model.accel_bias.sigma = in_range(arguments, "--accel-bias-mgal", 0.0, 1e6) * kMilligal;
  model.gyro_scale.sigma = in_range(arguments, "--gyro-scale-ppm", 0.0, 1e5) * kPpm;
  model.accel_scale.sigma = in_range(arguments, "--accel-scale-ppm", 0.0, 1e5) * kPpm;
  model.angle_random_walk = in_range(arguments, "--angle-random-walk-deg-per-sqrt-h", 0.0, 1e3) *
                            kDegree / std::sqrt(kHour);
  model.velocity_random_walk =
      in_range(arguments, "--velocity-random-walk-m-s-per-sqrt-h", 0.0, 1e3) / std::sqrt(kHour);
  return model;
}

void print_problems(const std::string& path, const leonav::CsvReport& report) {
  if (report.skipped == 0) return;
  std::cerr << kName << ": " << path << ": " << report.skipped << " rows not used\n";
  for (const std::string& problem : report.problems) std::cerr << "  " << problem << "\n";
}

int body(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (!arguments.positional().empty()) {
    throw UsageError("'" + arguments.positional().front() + "' belongs to no option (--help)");
  }
  const std::string truth_path = arguments.required("--truth");
  const std::string imu_path = arguments.required("--out");
  const double rate = in_range(arguments, "--rate", 10.0, 1000.0);
  const double seed = in_range(arguments, "--seed", 0.0, 9e15);
  leonav::SmoothTrackOptions options;
  options.position_cutoff_hz = in_range(arguments, "--smoothing-hz", 0.01, 100.0);
  options.max_gap_s = in_range(arguments, "--max-gap", 0.0, 60.0);
  leonav::SensorErrors errors(error_model(arguments), static_cast<std::uint64_t>(seed));

  const leonav::TruthCsv truth = leonav::read_truth_csv(truth_path);
  print_problems(truth_path, truth.report);
  const leonav::SmoothTrack track(truth.points, options);

  const auto interval_ns = static_cast<std::int64_t>(std::llround(1e9 / rate));
  std::vector<leonav::ImuSample> samples;
  const leonav::SplineMotion& motion = track.motion();
  leonav::GpsTime time = motion.start();
  while (time.plus_nanoseconds(interval_ns) <= truth.points.back().time) {
    const leonav::ImuSample ideal = leonav::ideal_sample(motion, time, interval_ns);
    samples.push_back(arguments.has("--ideal") ? ideal : errors.disturb(ideal));
    time = samples.back().time;
  }
  leonav::write_imu_csv(imu_path, samples);
  std::cout << imu_path << ": " << samples.size() << " samples over " << motion.duration_s()
            << " s; smoothed track within " << track.rms_deviation_m() << " m rms, "
            << track.max_deviation_m() << " m at most, of the truth\n";

  if (arguments.has("--truth-out")) {
    std::vector<leonav::TruthPoint> points;
    for (const leonav::TruthPoint& p : truth.points) points.push_back(motion.point(p.time));
    leonav::write_truth_csv(arguments.get("--truth-out"), points);
    std::cout << arguments.get("--truth-out") << ": " << points.size() << " points\n";
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool(kName, body, argc, argv); }
