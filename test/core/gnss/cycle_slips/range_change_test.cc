// The geometric check on rows of which it is known which have slipped.
#include "core/gnss/cycle_slips/range_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/catch.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav {
namespace {

// A sky of `count` directions, a change of position and clock, and noise of 1 sigma.
struct Sky {
  std::vector<RangeChangeRow> rows;
  RangeChangePrior prior;
};

Sky sky(std::size_t count, std::uint64_t seed, const Eigen::Vector3d& change_m,
        double clock_m = 12.0) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Sky sky;
  for (std::size_t i = 0; i < count; ++i) {
    RangeChangeRow row;
    const double azimuth = 2.399963 * static_cast<double>(i);
    const double sine = 0.26 + 0.7 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double cosine = std::sqrt(1.0 - sine * sine);
    row.direction = -Eigen::Vector3d(cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine);
    row.sigma_m = 0.01;
    row.residual_m = row.direction.dot(change_m) + clock_m + row.sigma_m * normal(generator);
    row.system_time = static_cast<int>(i % 2);
    sky.rows.push_back(row);
  }
  return sky;
}

Sky tight_sky(std::size_t count, std::uint64_t seed) {
  Sky s = sky(count, seed, {0.004, -0.003, 0.005});
  s.prior.change_is_free = false;
  s.prior.change_covariance = 2.5e-5 * Eigen::Matrix3d::Identity();
  return s;
}

// Of every row another one, in no order that a motion could imitate.
double slip_m(std::size_t row) { return 0.19 * (1.0 + static_cast<double>(7 * row % 11)); }

// Slips the first `count` rows; checks that these and no others are found.
void require_found(Sky s, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) s.rows[i].residual_m += slip_m(i);
  const RangeChangeResult result = range_change(s.rows, s.prior, {});
  CAPTURE(s.rows.size(), count, result.redundancy, result.scale);
  REQUIRE(result.status == RangeChangeStatus::kSlips);
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    CAPTURE(i);
    CHECK((result.rows[i].verdict == RangeChangeVerdict::kSlipped) == (i < count));
    if (i < count) {
      CHECK(result.rows[i].deviation_m == Approx(slip_m(i)).margin(0.08));
    }
  }
}

}  // namespace

TEST_CASE("Rows that agree tell the change of position and clock", "[range_change]") {
  const Eigen::Vector3d change(7.0, -4.0, 2.0);
  const Sky s = sky(16, 1, change, 299'792.458);  // a clock jump is a clock change
  const RangeChangeResult result = range_change(s.rows, s.prior, {});
  CHECK(result.status == RangeChangeStatus::kConsistent);
  CHECK((result.change_m - change).norm() < 0.05);
  CHECK(result.clock_change_m == Approx(299'792.458).margin(0.05));
  CHECK(result.redundancy == 12);
  for (const RangeChangeRowResult& row : result.rows)
    CHECK(row.verdict == RangeChangeVerdict::kConsistent);
}

TEST_CASE("Slips up to half of the spare rows are found", "[range_change]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    require_found(sky(16, seed, {7.0, -4.0, 2.0}), 1);
    require_found(sky(16, seed, {7.0, -4.0, 2.0}), 3);
    require_found(sky(24, seed, {7.0, -4.0, 2.0}), 9);
    require_found(tight_sky(8, seed), 3);
    require_found(tight_sky(3, seed), 1);
    require_found(tight_sky(20, seed), 9);
  }
}

TEST_CASE("What cannot be decided is said", "[range_change]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    // One spare row: that something slipped shows, but not what.
    Sky s = tight_sky(2, seed);
    s.rows[0].residual_m += 0.5;
    RangeChangeResult result = range_change(s.rows, s.prior, {});
    CHECK(result.status == RangeChangeStatus::kUndecidable);
    CHECK(result.rows[0].verdict == RangeChangeVerdict::kUndecided);
    CHECK(result.rows[1].verdict == RangeChangeVerdict::kUndecided);
    // Half against half by the same amount: either clock may be the true one.
    s = tight_sky(8, seed);
    for (std::size_t i = 0; i < 4; ++i) s.rows[2 * i + 1].residual_m += 0.5;
    result = range_change(s.rows, s.prior, {});
    CHECK(result.status == RangeChangeStatus::kUndecidable);
    // Without a prior four rows tell the unknowns and nothing else.
    s = sky(4, seed, {7.0, -4.0, 2.0});
    result = range_change(s.rows, s.prior, {});
    CHECK(result.status == RangeChangeStatus::kTooFewRows);
    CHECK(result.rows[0].verdict == RangeChangeVerdict::kNotTested);
  }
}

TEST_CASE("No slip is called one, and no scatter of all rows is", "[range_change]") {
  int slipped = 0, rows = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Sky s = sky(20, seed, {7.0, -4.0, 2.0});
    for (RangeChangeRow& row : s.rows) {
      if (seed % 2 == 0) row.sigma_m = 0.005;  // half of what they scatter by
    }
    for (const RangeChangeRowResult& row : range_change(s.rows, s.prior, {}).rows) {
      ++rows;
      slipped += row.verdict == RangeChangeVerdict::kSlipped;
    }
  }
  CHECK(slipped <= rows / 1000);
}

TEST_CASE("An error of the position matters where directions turn", "[range_change]") {
  Sky s = tight_sky(12, 3);
  const Eigen::Vector3d position_error(40.0, -30.0, 25.0);
  for (std::size_t i = 0; i < s.rows.size(); ++i) {
    s.rows[i].direction_change =
        7e-3 * Eigen::Vector3d(std::cos(1.0 * static_cast<double>(i)),
                               std::sin(2.0 * static_cast<double>(i)), 0.5);
    s.rows[i].residual_m += s.rows[i].direction_change.dot(position_error);
  }
  CHECK(range_change(s.rows, s.prior, {}).status != RangeChangeStatus::kConsistent);
  s.prior.position_covariance = 2500.0 * Eigen::Matrix3d::Identity();
  CHECK(range_change(s.rows, s.prior, {}).status == RangeChangeStatus::kConsistent);
}

TEST_CASE("Hostile rows are not tested and harm no other; nothing is allocated", "[range_change]") {
  Sky s = sky(16, 5, {7.0, -4.0, 2.0});
  s.rows[0].residual_m = std::numeric_limits<double>::quiet_NaN();
  s.rows[1].sigma_m = 0.0;
  s.rows[2].system_time = 77;
  s.rows[3].direction.x() = std::numeric_limits<double>::infinity();
  s.rows[5].residual_m += 1e300;
  s.rows[6].residual_m -= 3e6;
  start_counting_allocations();
  const RangeChangeResult result = range_change(s.rows, s.prior, {});
  CHECK(stop_counting_allocations() == 0);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(result.rows[i].verdict == RangeChangeVerdict::kNotTested);
  CHECK(result.rows[6].verdict == RangeChangeVerdict::kSlipped);
  CHECK(result.rows[8].verdict == RangeChangeVerdict::kConsistent);
  CHECK(range_change({}, {}, {}).status == RangeChangeStatus::kTooFewRows);
}

}  // namespace leonav
