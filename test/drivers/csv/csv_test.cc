#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>

#include "drivers/csv/imu_csv.h"
#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

using namespace leonav;
using Catch::Matchers::Contains;

namespace {

std::string path_of(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("leonav_csv_test_" + name)).string();
}
std::string write(const std::string& name, const std::string& content) {
  std::ofstream(path_of(name), std::ios::binary) << content;
  return path_of(name);
}
std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
const std::string kImuHeader(kImuCsvHeader);
const std::string kTruthHeader(kTruthCsvHeader);

}  // namespace

TEST_CASE("imu.csv: rates times interval", "[csv]") {
  const ImuCsv imu = read_imu_csv(write("imu", kImuHeader + "\n2400,10.000,1,2,3,4,5,6\n"
                                                            "2400,10.010,1,2,3,4,5,6\n"
                                                            "2400,10.030,1,2,3,4,5,6\r\n"
                                                            "2400,10.040,1,2,3,4,5,-9.8\n"
                                                            "2400,11.040,1,2,3,4,5,6\n"));
  REQUIRE(imu.samples.size() == 5);
  CHECK(imu.median_interval_ns == 10'000'000);
  CHECK(imu.samples[0].interval_ns == 10'000'000);
  CHECK(imu.samples[2].interval_ns == 20'000'000);
  CHECK((imu.samples[2].delta_theta_b - Eigen::Vector3d(0.02, 0.04, 0.06)).norm() < 1e-15);
  CHECK(imu.samples[3].delta_velocity_b.z() == Approx(-0.098));
  // A second without samples is a hole, not a second of constant rate.
  CHECK(imu.gaps == 1);
  CHECK(imu.samples[4].interval_ns == 10'000'000);
}

TEST_CASE("imu.csv: a bad row costs itself and is named", "[csv]") {
  const std::string path = write("imu_bad", kImuHeader +
                                                "\n2400,10.00,0,0,0,0,0,-9.8\n"
                                                "2400,10.01,nan,0,0,0,0,-9.8\n"
                                                "2400,10.01,0,0,0,0,0\n"
                                                "2400,10.01,0,0,,0,0,-9.8\n"
                                                "\n"
                                                "2400,9.99,0,0,0,0,0,-9.8\n"
                                                "garbage\n"
                                                "2400,700000,0,0,0,0,0,-9.8\n"
                                                "-1,10.01,0,0,0,0,0,-9.8\n"
                                                "2400,10.01,0,0,0,0,0,-9.8,7\n"
                                                "2400,10.02,0,0,0,0,0,-9.8\n");
  const ImuCsv imu = read_imu_csv(path);
  CHECK(imu.samples.size() == 2);
  CHECK(imu.report.rows == 2);
  CHECK(imu.report.skipped == 8);
  REQUIRE(imu.report.problems.size() == 8);
  CHECK(imu.report.problems[0] == path + ":3: gyro_x_rad_s: 'nan' is not a finite number");
  CHECK_THAT(imu.report.problems[3], Contains(":7: time does not fit the rows around it"));
}

TEST_CASE("a row with a wrong time costs itself, wherever it stands", "[csv]") {
  const auto imu_row = [](double tow) {
    return "\n2400," + std::to_string(tow) + ",0.1,0,0,0,0,-9.8";
  };
  const auto position_row = [](double tow) {
    return "\n2400," + std::to_string(tow) + ",45,9,100";
  };
  const std::string positions = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m";
  constexpr int kRows = 1000;
  for (const int wrong : {0, 1, 400, kRows - 2}) {
    for (const double by : {100.0, 0.5, -5.0, 3600.0}) {
      if (wrong == 0 && by < 0.0) continue;  // before the others: in order
      CAPTURE(wrong, by);
      std::string imu_text = kImuHeader, text = positions;
      for (int i = 0; i < kRows; ++i) {
        const double tow = 1000.0 + 0.01 * i + (i == wrong ? by : 0.0);
        imu_text += imu_row(tow);
        text += position_row(tow);
      }
      const bool last_two = wrong == kRows - 2 && by == 0.5;  // which of the two, nobody can tell
      const std::string line = ":" + std::to_string(wrong + 2 + (last_two ? 1 : 0)) + ": time does";
      const ImuCsv imu = read_imu_csv(write("leap", imu_text));
      CHECK(imu.samples.size() == kRows - 1);
      REQUIRE(imu.report.problems.size() == 1);
      CHECK_THAT(imu.report.problems[0], Contains(line));
      CHECK(imu.report.rows == kRows - 1);
      CHECK(imu.report.skipped == 1);
      const TruthCsv truth = read_truth_csv(write("leap", text));
      CHECK(truth.points.size() == kRows - 1);
      REQUIRE(truth.report.problems.size() == 1);
      CHECK_THAT(truth.report.problems[0], Contains(line));
      const SolutionCsv solution = read_solution_csv(write("leap", text));
      CHECK(solution.rows.size() == kRows - 1);
      CHECK(solution.report.skipped == 1);
    }
  }
}

TEST_CASE("imu.csv: nothing usable is an error that says what was expected", "[csv]") {
  CHECK_THROWS_WITH(read_imu_csv(write("none", "")), Contains(kImuHeader));
  CHECK_THROWS_WITH(read_imu_csv(write("none", "time,x\n1,2\n")), Contains(kImuHeader));
  CHECK_THROWS_WITH(read_imu_csv(write("none", kImuHeader + "\n")), Contains("no usable row"));
  CHECK_THROWS_WITH(read_imu_csv(write("none", kImuHeader + "\nx\ny\n")), Contains(":2: has 1"));
  CHECK_THROWS_AS(read_imu_csv(write("none", kImuHeader + "\n2400,1,0,0,0,0,0,0\n")), FileError);
  CHECK_THROWS_AS(read_imu_csv(write("none", std::string("\0\1\2", 3))), FileError);
}

TEST_CASE("imu.csv: written and read again", "[csv]") {
  std::vector<ImuSample> samples(50);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = static_cast<double>(i);
    samples[i].time = GpsTime::from_week_and_tow(2381, 604'799.9)
                          .plus_nanoseconds(static_cast<std::int64_t>(i) * 5'000'001);
    samples[i].interval_ns = 5'000'001;
    samples[i].delta_theta_b << 1e-4 * std::sin(x), -1e-3 * x, 1e-9 * x;
    samples[i].delta_velocity_b << 0.01 * x, -0.049, 0.001 * std::cos(x);
  }
  write_imu_csv(path_of("round"), samples);
  const ImuCsv again = read_imu_csv(path_of("round"));
  REQUIRE(again.samples.size() == samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(again.samples[i].time == samples[i].time);  // to the nanosecond, over the week's end
    CHECK(again.samples[i].interval_ns == samples[i].interval_ns);
    CHECK((again.samples[i].delta_theta_b - samples[i].delta_theta_b).norm() < 1e-14);
    CHECK((again.samples[i].delta_velocity_b - samples[i].delta_velocity_b).norm() < 1e-12);
  }
  CHECK_THROWS_AS(write_imu_csv("/no/such/folder/imu.csv", samples), FileError);
}

TEST_CASE("truth.csv: columns by name, empty ones unknown, more allowed", "[csv]") {
  const TruthCsv truth = read_truth_csv(
      write("truth",
            "\xEF\xBB\xBFheight_m,gps_tow_s,gps_week,longitude_deg,latitude_deg,yaw_deg,extra,"
            "v_north_m_s,v_east_m_s,v_down_m_s\n"
            "100,5.5,2400,-90,45,350,hello,1,2,3\n"
            "100,5.6,2400,-90,45,,,1,,3\n"
            "100,5.7,2400,-90,91,,,,,\n"
            "100,5.8,2400,,45,,,,,\n"));
  REQUIRE(truth.points.size() == 2);
  CHECK(truth.report.skipped == 2);
  const TruthPoint& p = truth.points[0];
  CHECK(p.position.latitude == Approx(M_PI / 4));
  CHECK(p.position.longitude == Approx(-M_PI / 2));
  CHECK(p.position.height == 100.0);
  CHECK(*p.yaw == Approx(-10.0 * M_PI / 180.0));
  CHECK_FALSE(p.roll);
  CHECK(*p.v_n == Eigen::Vector3d(1, 2, 3));
  CHECK_FALSE(truth.points[1].v_n);
  CHECK_FALSE(truth.points[1].yaw);
  CHECK_THROWS_WITH(read_truth_csv(write("truth_bad", "gps_week,gps_tow_s\n1,2\n")),
                    Contains("latitude_deg") && Contains(kTruthHeader));
}

TEST_CASE("a row of week 0 and time of week 0 has no time", "[csv]") {
  const std::string rows = "0,0,48,11,500\n0,-0.0,48,11,500\n2200,1,48,11,500\n";
  const TruthCsv truth = read_truth_csv(
      write("truth_zero", "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n" + rows));
  CHECK(truth.points.size() == 1);
  CHECK(truth.report.skipped == 2);
  CHECK_THAT(truth.report.problems.front(), Contains("there is no time"));
}

TEST_CASE("solution.csv: written and read again", "[csv]") {
  Solution solution;
  solution.time = GpsTime::from_week_and_tow(2381, 408'640.965);
  solution.latitude = 0.7;
  solution.longitude = -1.8351;
  solution.height = 1580.12345;
  solution.v_n << 1.5, -0.25, 0.001;
  solution.yaw = -3.0;
  solution.has_attitude = true;
  solution.sigma_p_n << 0.01, 0.02, 1234.5;
  solution.sigma_v_n << 0.1, 0.2, 0.3;
  solution.sigma_rpy << 0.001, 0.002, 0.03;
  solution.source = Source::kSmoother;
  solution.horizontal_protection_m = 1.25;
  solution.vertical_protection_m = 2.5;
  solution.heading_protection = 0.1;
  SolutionCsvWriter writer(path_of("solution"));
  writer.write(to_solution_row(solution, 17, 1.234));
  solution.time = solution.time.plus_seconds(1.0);
  solution.has_attitude = false;
  solution.source = Source::kAligning;
  solution.heading_protection = std::numeric_limits<double>::quiet_NaN();
  writer.write(to_solution_row(solution, std::nullopt, std::nullopt));
  writer.close();

  const SolutionCsv again = read_solution_csv(path_of("solution"));
  CHECK(again.report.skipped == 0);
  REQUIRE(again.rows.size() == 2);
  const SolutionRow& row = again.rows[0];
  CHECK(row.pva.time == GpsTime::from_week_and_tow(2381, 408'640.965));
  CHECK(std::abs(row.pva.position.latitude - 0.7) * 6.4e6 < 1e-5);
  CHECK(std::abs(row.pva.position.longitude + 1.8351) * 6.4e6 < 1e-5);
  CHECK(std::abs(row.pva.position.height - 1580.12345) < 5.1e-5);
  CHECK((*row.pva.v_n - solution.v_n).norm() < 1e-6);
  CHECK(*row.pva.yaw == Approx(-3.0).epsilon(1e-9));
  CHECK((*row.sigma_rpy - solution.sigma_rpy).norm() < 1e-7);
  CHECK(row.source == Source::kSmoother);
  CHECK(row.satellites == 17);
  CHECK(*row.pdop == Approx(1.23));
  CHECK(*row.horizontal_protection_m == 1.25);
  CHECK(*row.vertical_protection_m == 2.5);
  CHECK(*row.heading_protection == Approx(0.1).epsilon(1e-7));
  CHECK(*again.rows[1].vertical_protection_m == 2.5);
  CHECK_FALSE(again.rows[1].heading_protection);
  CHECK_FALSE(again.rows[1].pva.yaw);
  CHECK_FALSE(again.rows[1].satellites);
  CHECK(again.rows[1].source == Source::kAligning);
  CHECK(content(path_of("solution")).starts_with(std::string(kSolutionCsvHeader) + "\n2381,"));
}

TEST_CASE("solution.csv: what no IMU carries on is a prediction and not ins", "[csv]") {
  Solution solution;
  solution.time = GpsTime::from_week_and_tow(2381, 408'640.0);
  solution.source = Source::kInsOnly;
  SolutionCsvWriter writer(path_of("prediction"));
  for (const bool has_attitude : {false, true}) {
    solution.has_attitude = has_attitude;
    writer.write(to_solution_row(solution, std::nullopt, std::nullopt));
    solution.time = solution.time.plus_seconds(1.0);
    CHECK(source_name(solution.source, has_attitude) == (has_attitude ? "ins" : "prediction"));
    CHECK(source_name(Source::kEkf, has_attitude) == "ekf");
  }
  writer.close();
  const std::string text = content(path_of("prediction"));
  CHECK(text.find(",prediction,") < text.find(",ins,"));
  const SolutionCsv again = read_solution_csv(path_of("prediction"));
  CHECK(again.report.skipped == 0);
  REQUIRE(again.rows.size() == 2);
  for (const SolutionRow& row : again.rows) CHECK(row.source == Source::kInsOnly);
  CHECK(source_name(again.rows[0]) == "prediction");
  CHECK(source_name(again.rows[1]) == "ins");
}

TEST_CASE("A full disk is an error", "[csv]") {
  if (!std::filesystem::exists("/dev/full")) return;
  SolutionCsvWriter writer("/dev/full");
  for (int i = 0; i < 1000; ++i) writer.write({});
  CHECK_THROWS_AS(writer.close(), FileError);
}

TEST_CASE("The recorded files are read whole", "[csv]") {
  if (!test::have_shared_data("walk/imu.csv") || !test::have_shared_data("drive/truth.csv")) return;
  const ImuCsv imu = read_imu_csv(test::shared_data("walk/imu.csv"));
  std::cout << "walk/imu.csv: " << imu.samples.size() << " samples, " << imu.report.skipped
            << " skipped, " << imu.gaps << " gaps, median interval " << imu.median_interval_ns
            << " ns\n";
  CHECK(imu.samples.size() == 20'455);
  CHECK(imu.report.skipped == 0);
  const TruthCsv drive = read_truth_csv(test::shared_data("drive/truth.csv"));
  CHECK(drive.points.size() == 22'371);
  CHECK(drive.report.skipped == 0);
  CHECK_FALSE(drive.points[0].v_n);
  const TruthCsv walk = read_truth_csv(test::shared_data("walk/truth.csv"));
  CHECK(walk.points.size() == 536);
  CHECK(walk.points[0].v_n);
}
