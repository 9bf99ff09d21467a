// leonav-imu-from-truth as a user runs it, its noise-free output mechanized again.
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numbers>
#include <string>

#include "core/earth/rotation.h"
#include "core/inertial/strapdown/mechanization.h"
#include "drivers/csv/imu_csv.h"
#include "drivers/csv/truth_csv.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

using namespace leonav;

namespace {

std::string scratch(const std::string& name) {
  const auto folder = std::filesystem::temp_directory_path() / "leonav_imu_from_truth_test";
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

// Exit status of the tool; its words go to `output`.
int run(const std::string& arguments, const std::string& output = "/dev/null") {
  const std::string command =
      LEONAV_BIN_DIR "/leonav-imu-from-truth " + arguments + " > " + output + " 2>&1";
  const int status = std::system(command.c_str());
  return status < 0 ? -1 : status >> 8;
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

NavState state_of(const TruthPoint& point) {
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(point.position).transpose();
  NavState state;
  state.time = point.time;
  state.p_e = to_ecef(point.position);
  state.v_e = C_en * *point.v_n;
  state.q_eb = Eigen::Quaterniond(
      Eigen::Matrix3d(C_en * rotation_from_euler({*point.roll, *point.pitch, *point.yaw})));
  return state;
}

// Mechanizes `imu` from the true state at `begin_s` on; largest distance from the truth.
double drift(const ImuCsv& imu, const TruthCsv& truth, double begin_s, double duration_s) {
  const GpsTime begin = truth.points.front().time.plus_seconds(begin_s);
  std::size_t next = 0;
  while (truth.points[next].time < begin) ++next;
  Mechanization mechanization;
  mechanization.reset(state_of(truth.points[next]));
  const GpsTime end = truth.points[next].time.plus_seconds(duration_s);
  double worst = 0.0;
  for (const ImuSample& sample : imu.samples) {
    if (sample.start() < mechanization.state().time) continue;
    if (sample.time > end) break;
    mechanization.advance(sample);
    while (next < truth.points.size() && truth.points[next].time < sample.time) ++next;
    if (next == truth.points.size() || truth.points[next].time != sample.time) continue;
    const Eigen::Vector3d error = mechanization.state().p_e - to_ecef(truth.points[next].position);
    worst = std::max(worst, error.norm());
  }
  REQUIRE(mechanization.state().time == end);
  return worst;
}

// A town drive without attitude or velocity: stands, starts, turns, hills; rounded as a file is.
void write_synthetic_truth(const std::string& path) {
  std::vector<TruthPoint> points;
  const GpsTime start = GpsTime::from_week_and_tow(2300, 1000.0);
  for (int i = 0; i <= 9000; ++i) {
    const double t = 0.1 * i;
    const double phase = std::max(0.0, t - 20.0);
    const double along = 6.0 * phase - 60.0 * std::sin(phase / 10.0);  // stops every 63 s
    TruthPoint point;
    point.time = start.plus_nanoseconds(i * 100'000'000LL);
    point.position = {0.96 + 300.0 / 6.37e6 * std::sin(along / 300.0),
                      0.15 + 300.0 / 3.65e6 * (1.0 - std::cos(along / 300.0)),
                      40.0 + 5.0 * std::sin(along / 150.0)};
    points.push_back(point);
  }
  write_truth_csv(path, points);
}

}  // namespace

TEST_CASE("The ideal IMU of a synthetic drive leads back along it", "[tools]") {
  write_synthetic_truth(scratch("truth.csv"));
  for (const std::string rate : {"100", "200"}) {
    REQUIRE(run("--ideal --rate " + rate + " --truth " + scratch("truth.csv") + " --out " +
                scratch("imu.csv") + " --truth-out " + scratch("smooth.csv")) == 0);
    const ImuCsv imu = read_imu_csv(scratch("imu.csv"));
    const TruthCsv truth = read_truth_csv(scratch("smooth.csv"));
    CHECK(imu.gaps == 0);
    const double worst = drift(imu, truth, 0.0, 600.0);
    std::cout << "imu-from-truth, synthetic drive, " << rate << " Hz: " << worst
              << " m after 600 s\n";
    CHECK(worst < 0.05);
  }
}

TEST_CASE("The smoothed track stays with the truth and heads along its course", "[tools]") {
  write_synthetic_truth(scratch("truth.csv"));
  REQUIRE(run("--truth " + scratch("truth.csv") + " --out " + scratch("imu.csv") + " --truth-out " +
              scratch("smooth.csv")) == 0);
  const TruthCsv given = read_truth_csv(scratch("truth.csv"));
  const TruthCsv smooth = read_truth_csv(scratch("smooth.csv"));
  REQUIRE(given.points.size() == smooth.points.size());
  double distance = 0.0, sideslip = 0.0;
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    distance = std::max(
        distance, (to_ecef(given.points[i].position) - to_ecef(smooth.points[i].position)).norm());
    const Eigen::Vector3d v_n = *smooth.points[i].v_n;
    if (v_n.norm() < 3.0) continue;
    const double course = std::atan2(v_n.y(), v_n.x());
    sideslip = std::max(sideslip, std::abs(wrap_to_pi(course - *smooth.points[i].yaw)));
  }
  std::cout << "smoothed track: " << distance << " m from the truth at most, heading within "
            << sideslip * 180.0 / std::numbers::pi << " deg of the course\n";
  CHECK(distance < 0.02);
  CHECK(sideslip < 0.01);
}

TEST_CASE("The same seed gives the same file, another one another", "[tools]") {
  write_synthetic_truth(scratch("truth.csv"));
  const std::string common = "--truth " + scratch("truth.csv") + " --out ";
  REQUIRE(run(common + scratch("a.csv") + " --seed 7") == 0);
  REQUIRE(run(common + scratch("b.csv") + " --seed 7") == 0);
  REQUIRE(run(common + scratch("c.csv") + " --seed 8") == 0);
  CHECK(content(scratch("a.csv")) == content(scratch("b.csv")));
  CHECK(content(scratch("a.csv")) != content(scratch("c.csv")));
}

TEST_CASE("Sensor errors have the size of the data sheet", "[tools]") {
  write_synthetic_truth(scratch("truth.csv"));
  const std::string common = "--truth " + scratch("truth.csv") + " --out ";
  REQUIRE(run(common + scratch("ideal.csv") + " --ideal") == 0);
  REQUIRE(run(common + scratch("noisy.csv")) == 0);
  const ImuCsv ideal = read_imu_csv(scratch("ideal.csv"));
  const ImuCsv noisy = read_imu_csv(scratch("noisy.csv"));
  REQUIRE(ideal.samples.size() == noisy.samples.size());
  double angle = 0.0, velocity = 0.0, seconds = 0.0;
  for (std::size_t i = 0; i < ideal.samples.size(); ++i) {
    const ImuSample &a = ideal.samples[i], &b = noisy.samples[i];
    angle += (b.delta_theta_b - a.delta_theta_b).squaredNorm() / 3.0;
    velocity += (b.delta_velocity_b - a.delta_velocity_b).squaredNorm() / 3.0;
    seconds += a.interval_s();
  }
  const double hour = 3600.0 / seconds;
  CHECK(std::sqrt(angle * hour) * 180.0 / std::numbers::pi == Approx(0.05).epsilon(0.01));
  CHECK(std::sqrt(velocity * hour) == Approx(0.1).epsilon(0.01));
}

TEST_CASE("Wrong use and bad files end with a message and no success", "[tools]") {
  const std::string out = scratch("unwritten.csv"), words = scratch("words.txt");
  CHECK(run("", words) == 2);
  CHECK(run("--truth x.csv --out " + out + " --rate nonsense", words) == 2);
  CHECK(run("--truth x.csv --out " + out + " --rate 1e9", words) == 2);
  CHECK(run("--truth " + scratch("absent.csv") + " --out " + out, words) == 1);
  CHECK(content(words).find("absent.csv") != std::string::npos);
  std::ofstream(scratch("short.csv")) << kTruthCsvHeader << "\n2300,1.0,50,8,100,,,,,,\n";
  CHECK(run("--truth " + scratch("short.csv") + " --out " + out, words) == 1);
  std::ofstream hole(scratch("hole.csv"));
  hole << kTruthCsvHeader << "\n";
  for (int i = 0; i < 60; ++i)
    hole << "2300," << (i < 30 ? i : i + 30) * 0.1 << ",50,8,100,,,,,,\n";
  hole.close();
  CHECK(run("--truth " + scratch("hole.csv") + " --out " + out, words) == 1);
  CHECK(content(words).find("hole of 3.1") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(out));
  write_synthetic_truth(scratch("truth.csv"));
  CHECK(run("--truth " + scratch("truth.csv") + " --out /dev/full", words) == 1);
  CHECK(run("--truth " + scratch("truth.csv") + " --out " + scratch("no/such/folder.csv"), words) ==
        1);
  CHECK(run("--help", words) == 0);
}

TEST_CASE("The recorded drive gets an IMU that leads back along it", "[tools]") {
  if (!test::have_shared_data("drive/truth.csv")) return;
  const std::string words = scratch("words.txt");
  REQUIRE(run("--ideal --truth " + test::shared_data("drive/truth.csv") + " --out " +
                  scratch("imu.csv") + " --truth-out " + scratch("smooth.csv"),
              words) == 0);
  std::cout << content(words);
  const ImuCsv imu = read_imu_csv(scratch("imu.csv"));
  const TruthCsv truth = read_truth_csv(scratch("smooth.csv"));
  for (const double begin : {10.0, 800.0, 1500.0}) {
    const double worst = drift(imu, truth, begin, 600.0);
    std::cout << "imu-from-truth, drive from second " << begin << ": " << worst
              << " m after 600 s\n";
    CHECK(worst < 0.05);
  }
}
