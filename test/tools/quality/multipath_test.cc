#include "tools/quality/internal/multipath.h"
#include "core/base/angle.h"

#include <cmath>
#include <numbers>

#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kL1 = 1575.42e6, kL2 = 1227.60e6;
const MultipathLevels::Signal kSignal{{System::kGps, 7}, {'1', 'C'}};

double rms_of_all(const MultipathLevels& levels) {
  return levels.signals().at(kSignal).all().rms_m();
}

}  // namespace

// Range, clocks, troposphere: any common value; ionosphere delays codes and advances carriers.
TEST_CASE("the combination holds the code's multipath and a constant, and nothing else") {
  const double l1_bias = 1234.5, l2_bias = -777.25, gamma = kL1 * kL1 / (kL2 * kL2);
  double first_level = 0.0, second_level = 0.0;
  for (int k = 0; k < 20; ++k) {
    const double common = 2.1e7 + 813.0 * k, iono = 3.0 + 0.4 * k;
    const double m1 = 0.7 * std::sin(0.9 * k), m2 = -1.3 * std::cos(0.4 * k);
    const double p1 = common + iono + m1, p2 = common + gamma * iono + m2;
    const double l1 = common - iono + l1_bias, l2 = common - gamma * iono + l2_bias;
    const double mp1 = multipath_combination_m(p1, l1, l2, kL1, kL2) - m1;
    const double mp2 = multipath_combination_m(p2, l2, l1, kL2, kL1) - m2;
    if (k == 0) {
      first_level = mp1;
      second_level = mp2;
    }
    CHECK(std::abs(mp1 - first_level) < 1e-6);
    CHECK(std::abs(mp2 - second_level) < 1e-6);
    // As Estey and Meertens write them, a = f1^2 / f2^2.
    const double a = gamma;
    CHECK(mp1 + m1 ==
          Approx(p1 - (1 + 2 / (a - 1)) * l1 + 2 / (a - 1) * l2).margin(1e-6).epsilon(0));
    CHECK(mp2 + m2 ==
          Approx(p2 - 2 * a / (a - 1) * l1 + (2 * a / (a - 1) - 1) * l2).margin(1e-6).epsilon(0));
  }
}

TEST_CASE("each arc gets its own level; a slip that is not detected spoils the rms") {
  MultipathLevels levels, untold;
  double squares = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double multipath = 0.5 * std::sin(2.0 * std::numbers::pi * k / 40.0);  // whole periods
    const bool after = k >= 200;
    squares += multipath * multipath;
    levels.add(kSignal, after ? 2 : 1, multipath + (after ? 90.0 : -7.0), 0.3);
    untold.add(kSignal, 1, multipath + (after ? 90.0 : -7.0), 0.3);
  }
  levels.finish();
  untold.finish();
  CHECK(rms_of_all(levels) == Approx(std::sqrt(squares / 400.0 * 200.0 / 199.0)).epsilon(1e-9));
  CHECK(rms_of_all(untold) > 40.0);
  CHECK(levels.means_m().at(0) == Approx(-7.0).margin(1e-9));
  CHECK(levels.means_m().at(1) == Approx(90.0).margin(1e-9));
  CHECK(levels.signals().at(kSignal).arcs == 2);
}

// About the arc's mean, not the bin's: what differs between elevations is multipath too.
TEST_CASE("bins of elevation hold their share about the mean of the whole arc") {
  MultipathLevels levels;
  for (int k = 0; k < 50; ++k) levels.add(kSignal, 9, 1.0, 0.2);   // 11 degrees
  for (int k = 0; k < 50; ++k) levels.add(kSignal, 9, -1.0, 0.8);  // 46 degrees
  levels.finish();
  const auto& bins = levels.signals().at(kSignal).bins;
  CHECK(bins[1].samples == 50);
  CHECK(bins[1].rms_m() == Approx(std::sqrt(100.0 / 99.0)));
  CHECK(bins[4].rms_m() == Approx(std::sqrt(100.0 / 99.0)));
  CHECK(std::isnan(bins[0].rms_m()));
}

TEST_CASE("short arcs are left out and counted") {
  MultipathLevels levels;
  for (std::uint64_t k = 0; k + 1 < MultipathLevels::kMinSamples; ++k)
    levels.add(kSignal, 1, 50.0 * static_cast<double>(k), 0.3);
  for (std::uint64_t k = 0; k < MultipathLevels::kMinSamples; ++k)
    levels.add(kSignal, 2, k % 2 == 0 ? 3.0 : 5.0, 0.3);
  levels.finish();
  const MultipathOfSignal& signal = levels.signals().at(kSignal);
  CHECK(signal.arcs == 1);
  CHECK(signal.short_arcs == 1);
  CHECK(signal.short_arc_samples == MultipathLevels::kMinSamples - 1);
  CHECK(signal.all().rms_m() == Approx(std::sqrt(10.0 / 9.0)));
  CHECK(std::isnan(levels.means_m().at(0)));
}

TEST_CASE("bins of elevation at their edges") {
  CHECK(elevation_bin(-0.1) == 0);
  CHECK(elevation_bin(9.99 * kDegree) == 0);
  CHECK(elevation_bin(10.01 * kDegree) == 1);
  CHECK(elevation_bin(90.0 * kDegree) == 8);
  CHECK(elevation_bin(std::nan("")) == kNoElevation);
}
