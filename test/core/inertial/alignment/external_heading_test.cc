#include "core/inertial/alignment/external_heading.h"

#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kStillRate = 0.05, kMinSpeed = 1.0;

// `seconds` of samples at 100 Hz with this rate about the vertical, from `start`.
GpsTime turn(ExternalHeading* given, double rate, double seconds, GpsTime start) {
  for (int i = 0; i < static_cast<int>(100 * seconds); ++i) {
    ImuSample sample;
    sample.interval_ns = 10'000'000;
    start = start.plus_nanoseconds(sample.interval_ns);
    sample.time = start;
    sample.delta_theta_b.z() = rate * 0.01;
    given->end_on_motion(sample, kStillRate);
  }
  return start;
}

const GpsTime kBeginOfWeek = GpsTime::from_week_and_tow(2400, 0.0);

ExternalHeading used_heading() {
  ExternalHeading given;
  given.set({1.0, 0.1});
  given.use();
  return given;
}

}  // namespace

TEST_CASE("A told heading waits for its first use, whatever moves before", "[ins]") {
  ExternalHeading given;
  CHECK_FALSE(given.get());
  given.set({1.0, 0.1});
  given.end_on_motion(10.0, 0.1, kMinSpeed);
  turn(&given, 1.0, 5.0, kBeginOfWeek);
  REQUIRE(given.get());
  CHECK(given.get()->heading == 1.0);
  CHECK(given.get()->sigma == 0.1);
}

TEST_CASE("A used heading is good again only while the vehicle stands", "[ins]") {
  ExternalHeading standing = used_heading();
  GpsTime time = turn(&standing, 0.02, 10.0, kBeginOfWeek);  // a gyro bias
  standing.end_on_motion(0.1, 0.05, kMinSpeed);
  CHECK(standing.get());
  SECTION("driven") { standing.end_on_motion(2.0, 0.05, kMinSpeed); }
  SECTION("driven, for all one knows") { standing.end_on_motion(0.1, 2.0, kMinSpeed); }
  SECTION("speed is no number") { standing.end_on_motion(std::nan(""), 0.1, kMinSpeed); }
  SECTION("turned on the spot") { turn(&standing, 0.5, 2.0, time); }
  SECTION("nobody knows what it did for a second") {
    turn(&standing, 0.0, 0.5, time.plus_seconds(1.0));
  }
  CHECK_FALSE(standing.get());
  standing.set({2.0, 0.1});
  REQUIRE(standing.get());
  CHECK(standing.get()->heading == 2.0);
}

TEST_CASE("Shaking is not turning", "[ins]") {
  ExternalHeading given = used_heading();
  GpsTime time = kBeginOfWeek;
  for (int i = 0; i < 100; ++i) {
    time = turn(&given, 1.0, 0.02, time);
    time = turn(&given, -1.0, 0.02, time);
  }
  CHECK(given.get());
}
