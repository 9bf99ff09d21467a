#include "tools/evaluate/integrity.h"

#include <cmath>
#include <filesystem>
#include <random>

#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"
#include "tools/evaluate/internal/clopper_pearson.h"

using namespace leonav;

namespace {

GpsTime at(double seconds) {
  return GpsTime::from_week_and_tow(2300, 6000.0).plus_seconds(seconds);
}

// The probability of at most `events` of `trials`, term by term.
double binomial_cdf(int events, int trials, double p) {
  double term = std::pow(1.0 - p, trials), sum = term;
  for (int i = 1; i <= events; ++i) {
    term *= p / (1.0 - p) * (trials - i + 1) / i;
    sum += term;
  }
  return sum;
}

}  // namespace

TEST_CASE("the upper bound of a share is where so few events become improbable") {
  // Without events: 1 - 0.05^(1/n), the rule of three.
  CHECK(upper_bound_of_share(0, 100) == Approx(1.0 - std::pow(0.05, 0.01)).epsilon(1e-10));
  CHECK(upper_bound_of_share(0, 1'000'000) == Approx(2.9957e-6).epsilon(1e-4));
  for (const auto& [events, trials] : {std::pair(1, 20), std::pair(3, 50), std::pair(17, 200)}) {
    const double bound =
        upper_bound_of_share(static_cast<std::size_t>(events), static_cast<std::size_t>(trials));
    CHECK(binomial_cdf(events, trials, bound) == Approx(0.05).epsilon(1e-9));
  }
  CHECK(upper_bound_of_share(7, 7) == 1.0);
  CHECK(upper_bound_of_share(0, 0) == 1.0);
}

TEST_CASE("every epoch is in one region of each alert limit") {
  // Error and level: the Stanford diagram's regions about limits of 1 m and 5 m.
  const std::vector<LevelSample> samples = {
      {at(0), 0.5, 0.9},  // nominal for both
      {at(1), 0.5, 3.0},  // unavailable for 1 m, nominal for 5 m
      {at(2), 0.9, 0.8},  // misleading for both
      {at(3), 2.0, 0.9},  // hazardous for 1 m, misleading for 5 m
      {at(4), 4.0, 3.0},  // unavailable and misleading for 1 m, misleading for 5 m
      {at(5), 9.0, 7.0},  // unavailable and misleading for both
      {at(6), 6.0, 7.0},  // unavailable for both
      {at(7), 1.0, 1.0},  // equal is within, for the level and for the limit
  };
  const IntegrityCounts counts = count_integrity(samples, {1.0, 5.0}, 60.0);
  CHECK(counts.epochs == 8);
  CHECK(counts.misleading == 4);
  CHECK(counts.largest_ratio == Approx(2.0 / 0.9));
  REQUIRE(counts.limits.size() == 2);
  const AlertLimitCounts &one = counts.limits[0], &five = counts.limits[1];
  CHECK(one.nominal == 2);
  CHECK(one.misleading == 1);
  CHECK(one.hazardous == 1);
  CHECK(one.unavailable == 2);
  CHECK(one.unavailable_misleading == 2);
  CHECK(one.available() == 4);
  CHECK(five.nominal == 3);
  CHECK(five.misleading == 3);
  CHECK(five.hazardous == 0);
  CHECK(five.unavailable == 1);
  CHECK(five.unavailable_misleading == 1);
}

TEST_CASE("a block counts once, on a grid of GPS time") {
  std::vector<LevelSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({at(i), 0.1, 1.0});
  for (const int i : {12, 13, 14, 47}) samples[static_cast<std::size_t>(i)].error = 20.0;
  samples.erase(samples.begin() + 60,
                samples.begin() + 80);  // blocks without an epoch do not count
  const IntegrityCounts counts = count_integrity(samples, {10.0}, 10.0);
  CHECK(counts.misleading == 4);
  CHECK(counts.blocks == 8);
  CHECK(counts.misleading_blocks == 2);
  CHECK(counts.limits[0].hazardous == 4);
  CHECK(counts.limits[0].hazardous_blocks == 2);
}

TEST_CASE("errors are counted in tenths of their sigma, in a block the largest") {
  const std::vector<LevelSample> samples = {
      {at(0), 0.55, 3.0, 0.1},           // 5.5 sigma
      {at(1), 0.77, 3.0, 0.1},           // 7.7 sigma, the largest of its block
      {at(11), 0.559, 3.0, 0.1},         // 5.59 sigma, rounded down
      {at(21), 9.0, 3.0, std::nullopt},  // states no sigma
      {at(31), 9.0, 3.0, 0.0},           // one that is wrong without limit
  };
  const IntegrityCounts counts = count_integrity(samples, {}, 10.0);
  CHECK(counts.blocks == 4);
  const std::map<int, MultipleCounts> expected = {{55, {2, 1}}, {77, {1, 1}}, {1'000'000, {1, 1}}};
  CHECK(counts.multiples == expected);
  CHECK(counts.diagram.empty());
}

TEST_CASE("a diagram has twenty bins a decade from a millimetre on") {
  CHECK(diagram_bin(0.0) == 0);
  CHECK(diagram_bin(0.00111) == 0);
  CHECK(diagram_bin(0.00113) == 1);
  CHECK(diagram_bin(0.0101) == 20);
  CHECK(diagram_bin(1.01) == 60);
  CHECK(diagram_bin(9.99) == 79);
  CHECK(diagram_bin(1e30) == 239);
  const IntegrityCounts counts = count_integrity(
      {{at(0), 0.0, 1.01}, {at(1), 0.0005, 1.02}, {at(2), 0.0101, 9.99}}, {1.0}, 60.0);
  const std::map<std::pair<int, int>, std::size_t> expected = {{{0, 60}, 2}, {{20, 79}, 1}};
  CHECK(counts.diagram == expected);
}

TEST_CASE("runs add up") {
  const std::vector<double> limits = {1.0};
  IntegrityEvaluation sum, other;
  sum.horizontal = count_integrity({{at(0), 2.0, 0.5, 0.3}, {at(1), 0.1, 0.5, 0.3}}, limits, 60.0);
  other.horizontal = count_integrity({{at(500), 0.1, 3.0, 0.3}}, limits, 60.0);
  sum.horizontal.observed_s = 2.0;
  other.horizontal.observed_s = 0.5;
  add_counts(other, &sum);
  CHECK(sum.horizontal.epochs == 3);
  CHECK(sum.horizontal.expected == 3);
  CHECK(sum.horizontal.misleading == 1);
  CHECK(sum.horizontal.blocks == 2);
  CHECK(sum.horizontal.limits[0].hazardous == 1);
  CHECK(sum.horizontal.limits[0].unavailable == 1);
  CHECK(sum.horizontal.largest_ratio == 4.0);
  CHECK(sum.horizontal.observed_s == 2.5);
  const std::map<int, MultipleCounts> multiples = {{3, {2, 1}}, {66, {1, 1}}};
  CHECK(sum.horizontal.multiples == multiples);
  CHECK(sum.horizontal.diagram.size() == 3);
  CHECK(sum.horizontal.diagram.at({diagram_bin(0.1), diagram_bin(3.0)}) == 1);
}

TEST_CASE("errors meet the levels of their own direction; a course is no truth of the heading") {
  ErrorSample sample;
  sample.time = at(0);
  sample.neu = {3.0, 4.0, -6.0};
  sample.rpy[2] = -0.2;
  sample.levels = {7.0, 8.0, 0.3};
  sample.sigma_neu = {0.6, 0.8, 0.5};
  sample.sigma_yaw = 0.05;
  ErrorSample by_course = sample, without = sample;
  by_course.yaw_from_course = true;
  without.levels = {};
  const std::vector<ErrorSample> errors = {sample, by_course, without};
  const auto horizontal = horizontal_samples(errors);
  REQUIRE(horizontal.size() == 2);
  CHECK(horizontal[0].error == Approx(5.0));
  CHECK(horizontal[0].level == 7.0);
  CHECK(*horizontal[0].sigma == Approx(1.0));
  CHECK(vertical_samples(errors)[0].error == 6.0);
  CHECK(*vertical_samples(errors)[0].sigma == 0.5);
  REQUIRE(heading_samples(errors).size() == 1);
  CHECK(heading_samples(errors)[0].error == 0.2);
  CHECK(*heading_samples(errors)[0].sigma == 0.05);
  Comparison comparison;
  comparison.errors = {without};
  CHECK_THROWS(evaluate_integrity("run", comparison, {}));
}

TEST_CASE("epochs without an answer are expected and make the system unavailable") {
  Comparison comparison;
  ErrorSample sample;
  sample.time = at(0);
  sample.levels = {0.5, 0.5, std::nullopt};
  comparison.errors = {sample};
  comparison.expected_epochs = 5;
  comparison.interval_s = 0.5;
  comparison.without_truth = 1;
  const auto evaluation = evaluate_integrity("run", comparison, {});
  CHECK(evaluation.horizontal.expected == 4);
  CHECK(evaluation.horizontal.epochs == 1);
  CHECK(evaluation.horizontal.observed_s == 0.5);
  CHECK(evaluation.heading.epochs == 0);
  CHECK(to_table({evaluation}, {}).find("available  25.000 %") != std::string::npos);
}

TEST_CASE("leonav-eval --integrity prints, writes JSON and draws what it counts") {
  if (!test::have_programs("leonav-eval", "leonav-integrity-plots")) return;
  const std::string position = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m";
  std::string truth = position + "\n";
  std::string solution =
      position +
      ",std_north_m,std_east_m,std_down_m,protection_horizontal_m,protection_vertical_m,"
      "protection_heading_deg\n";
  for (int i = 0; i < 120; ++i) {
    const std::string time = "2200," + std::to_string(1020 + i) + ",";
    truth += time + "45.0,7.0,100.0\n";
    // 11.1 m north in two epochs, whose level is 5 m.
    solution +=
        time + (i == 7 || i == 8 ? "45.0001" : "45.0") + ",7.0,101.0,0.3,0.4,0.3,5.0,2.0,\n";
  }
  const test::TemporaryFile truth_file("truth.csv", truth), file("solution.csv", solution);
  const std::string json = file.beside("counts.json"), plots = file.beside("plots");
  const std::string words = "--integrity --truth '" + truth_file.path() + "' ";
  const auto run =
      test::run_program("leonav-eval", words + "--alert-limit-m 1,10 --json '" + json +
                                           "' --plots '" + plots + "' 'a=" + file.path() + "'");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(run.out.find("120 epochs with a level, of 120 expected; misleading 2 (1.6667 %") !=
        std::string::npos);
  CHECK(run.out.find("1 of 2 misleading") != std::string::npos);
  const std::string counts = test::text_of(json);
  CHECK(
      counts.find("{\"limit_m\": 10, \"nominal\": 118, \"misleading\": 0, \"hazardous\": 2, "
                  "\"unavailable\": 0, \"unavailable_misleading\": 0, \"hazardous_blocks\": 1}") !=
      std::string::npos);
  CHECK(counts.find("\"observed_s\": 120.000") != std::string::npos);
  // 11.112 m of a sigma of 0.5 m, and 1 m of 0.3 m; 5 m is the 74th bin, 1 m the 60th, 2 m the
  // 66th.
  CHECK(counts.find("\"multiples\": [[0, 118, 1], [222, 2, 1]],\n   \"diagram\": [[0, 73, 118], "
                    "[80, 73, 2]]") != std::string::npos);
  CHECK(counts.find("\"multiples\": [[33, 120, 2]],\n   \"diagram\": [[") != std::string::npos);
  for (const char* name : {"stanford_horizontal.png", "stanford_vertical.png", "integrity.csv"})
    CHECK(std::filesystem::file_size(plots + "/" + name) > 1000);
  const auto two =
      test::run_program("leonav-eval", words + "'" + file.path() + "' '" + file.path() + "'");
  CHECK(two.out.find("all runs\n  horizontal 240 epochs") != std::string::npos);
  CHECK(test::run_program("leonav-eval", words + "--alert-limit-m 1,x '" + file.path() + "'")
            .exit_code == 2);
  CHECK(test::run_program("leonav-eval", "--alert-limit-m 1 --truth '" + truth_file.path() + "' '" +
                                             file.path() + "'")
            .exit_code == 2);
  // A file without levels.
  const auto none = test::run_program("leonav-eval", words + "'" + truth_file.path() + "'");
  CHECK(none.exit_code == 1);
  CHECK(none.err.find("states no protection level") != std::string::npos);
}
