#include "core/gnss/measurement/geometry_free.h"

#include <cmath>
#include <random>

#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kInterval_s = 0.25;
const GeometryFreeNoise kNoise{0.0028, 0.0005, 0.00002};  // 2 mm on each carrier

// The rule of carrier_track: 5 sigma and 2 cm end the arc.
class Detector {
 public:
  // True: the arc ended here.
  bool add(double value_m) {
    if (!running_) {
      trend_.start(value_m, kInterval_s, kNoise, false);
      running_ = true;
      return false;
    }
    const auto seen = trend_.innovation(value_m, kInterval_s, kNoise);
    if (std::abs(seen.value_m) > 5.0 * seen.sigma_m && std::abs(seen.value_m) > 0.02) {
      trend_.start(value_m, kInterval_s, kNoise, true);
      return true;
    }
    trend_.update(value_m, kInterval_s, kNoise);
    return false;
  }

 private:
  GeometryFreeTrend trend_;
  bool running_ = false;
};

}  // namespace

// A hand-held antenna: carriers fade from 2 mm of noise to 11 mm within an epoch (geometry-free
// 15 mm), with no slip at all.
TEST_CASE("noise that grows at once is learnt, also by the arcs that it ends") {
  int ended = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> unit;
    Detector detector;
    for (int k = 0; k < 100; ++k) REQUIRE_FALSE(detector.add(0.0028 * unit(random)));
    for (int k = 0; k < 400; ++k) ended += detector.add(0.015 * unit(random)) ? 1 : 0;
  }
  CAPTURE(ended);
  CHECK(ended < 160);  // of 8000 epochs; 471 where only what ends no arc is learnt from
}

// What is learnt from a slip must not hide the next one: 5.4 cm, a cycle on L1 and on L2.
TEST_CASE("a slip does not make the trend deaf to the next") {
  std::mt19937 random(7);
  std::normal_distribution<double> unit;
  for (int trial = 0; trial < 50; ++trial) {
    Detector detector;
    double level_m = 0.0;
    for (int k = 0; k < 60; ++k) REQUIRE_FALSE(detector.add(0.0028 * unit(random)));
    for (const double slip_m : {0.19, -1.3, 0.054, -0.054}) {
      level_m += slip_m;
      CAPTURE(slip_m);
      CHECK(detector.add(level_m + 0.0028 * unit(random)));
      for (int k = 0; k < 8; ++k) CHECK_FALSE(detector.add(level_m + 0.0028 * unit(random)));
    }
  }
}
