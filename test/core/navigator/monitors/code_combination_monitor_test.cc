// CodeCombinationMonitor on made-up epochs: variances against the equations of its header.
#include "core/navigator/monitors/code_combination_monitor.h"

#include <cmath>
#include <vector>

#include "begin_of_week.h"
#include "support/catch.h"

namespace leonav {
namespace {

constexpr auto kPairs = CodeCombination::kIonosphereFree;
constexpr auto kSingle = CodeCombination::kSingleFrequency;
constexpr bool kCarriersKeep = true, kCodesKeep = false;

// Noise of a metre, a pair of GPS L1 and L2, and two metres by the ionosphere at each satellite.
struct Sky {
  int satellites = 6;
  double pair_noise = 8.9, single_noise = 0.5, ionosphere = 4.0;
  int bands = 1;  // codes of a satellite
};

MeasurementEpoch epoch_of(const Sky& sky, double t) {
  MeasurementEpoch epoch;
  epoch.time = test::kBeginOfWeek.plus_seconds(t);
  for (int i = 0; i < sky.satellites; ++i) {
    SatelliteInView view;
    view.satellite = {System::kGps, static_cast<std::uint16_t>(i + 1)};
    view.elevation = 0.3 + 0.2 * (i % 6);
    view.code_variances = {sky.pair_noise, sky.single_noise, sky.ionosphere};
    epoch.satellites.push_back(view);
    for (int band = 0; band < sky.bands; ++band) {
      Measurement code;
      code.satellite_index = static_cast<std::uint16_t>(i);
      code.code = {band == 0 ? '1' : '2', 'C'};
      code.sigma = 1.0;
      epoch.measurements.push_back(code);
    }
  }
  return epoch;
}

// What has been learned: errors of codes are `factor` times as large as configured.
LearnedErrors learned(double factor, bool learns = true) {
  EkfConfig config;
  config.learn_errors = learns;
  LearnedErrors errors(config);
  errors.start(factor, 1.0, 1.0);
  return errors;
}

// Epochs once a second from one run to the next.
class Driver {
 public:
  explicit Driver(CodeCombination configured = CodeCombination::kAutomatic)
      : monitor_(configured) {}
  CodeCombination after(int seconds, const Sky& sky, double factor, bool carriers_keep_position,
                        bool learns = true) {
    const LearnedErrors errors = learned(factor, learns);
    for (int i = 0; i < seconds; ++i)
      monitor_.add(epoch_of(sky, t_ += 1.0), errors, carriers_keep_position);
    return monitor_.combination();
  }
  CodeCombination now() const { return monitor_.combination(); }

 private:
  CodeCombinationMonitor monitor_;
  double t_ = 0.0;
};

TEST_CASE("pairs come first, and stay while carriers keep the position, however noisy codes are") {
  Driver driver;
  CHECK(driver.now() == kPairs);
  CHECK(driver.after(300, {}, 30.0, kCarriersKeep) == kPairs);
}

TEST_CASE("a few noisy codes that keep the position are taken as single frequencies") {
  Driver driver;
  CHECK(driver.after(60, {}, 10.0, kCodesKeep) == kSingle);
  SECTION("until carriers keep the position again") {
    CHECK(driver.after(60, {}, 10.0, kCarriersKeep) == kPairs);
  }
  SECTION("until there are many satellites, over which the noise averages") {
    Sky many;
    many.satellites = 80;
    CHECK(driver.after(60, many, 2.0, kCodesKeep) == kPairs);
  }
  SECTION("until codes are good again") {
    Sky good;
    good.satellites = 20;
    CHECK(driver.after(60, good, 1.0, kCodesKeep) == kPairs);
  }
}

TEST_CASE("good codes of many satellites are paired although they keep the position") {
  Sky many;
  many.satellites = 30;
  CHECK(Driver().after(300, many, 1.0, kCodesKeep) == kPairs);
}

// The factor s at which pairs have exp(`log_ratio`) times the variance of single frequencies:
//   s^2 pair / n = exp(log_ratio) (s^2 single / n + 0.2 ionosphere)
double factor_of(double log_ratio, const Sky& sky) {
  const double ratio = std::exp(log_ratio);
  return std::sqrt(ratio * 0.2 * sky.ionosphere * sky.satellites /
                   (sky.pair_noise - ratio * sky.single_noise));
}

TEST_CASE("what is hardly better changes nothing, neither to single frequencies nor back") {
  Sky sky;
  sky.satellites = 20;
  for (const double log_ratio : {-0.05, 0.0, 0.1, 0.25}) {
    const double factor = factor_of(log_ratio, sky);
    CAPTURE(log_ratio, factor);
    REQUIRE(factor > 1.0);
    Driver driver;
    CHECK(driver.after(300, sky, factor, kCodesKeep) == kPairs);
    REQUIRE(driver.after(60, sky, 30.0, kCodesKeep) == kSingle);
    CHECK(driver.after(300, sky, factor, kCodesKeep) == kSingle);
  }
  CHECK(Driver().after(300, sky, factor_of(0.35, sky), kCodesKeep) == kSingle);
  Driver back;
  REQUIRE(back.after(60, sky, 30.0, kCodesKeep) == kSingle);
  CHECK(back.after(300, sky, factor_of(-0.15, sky), kCodesKeep) == kPairs);
}

TEST_CASE("two bands of a satellite count as one satellite") {
  Sky sky;
  sky.satellites = 20;
  const double factor = factor_of(0.2, sky);
  sky.bands = 2;
  Driver driver;
  CHECK(driver.after(300, sky, factor, kCodesKeep) == kPairs);
  REQUIRE(driver.after(60, sky, 30.0, kCodesKeep) == kSingle);
  CHECK(driver.after(300, sky, factor, kCodesKeep) == kSingle);
}

TEST_CASE("one epoch changes no combination, whatever it says") {
  Sky sky;
  sky.satellites = 20;
  Driver driver;
  REQUIRE(driver.after(100, sky, 1.0, kCodesKeep) == kPairs);
  CHECK(driver.after(1, {}, 30.0, kCodesKeep) == kPairs);
  CHECK(driver.after(100, sky, 1.0, kCodesKeep) == kPairs);
}

TEST_CASE("satellites without a pair, and epochs without satellites, say nothing") {
  Sky without;
  without.pair_noise = without.single_noise = without.ionosphere = 0.0;
  Sky empty;
  empty.satellites = 0;
  for (const Sky& sky : {without, empty}) {
    Driver driver;
    CHECK(driver.after(100, sky, 30.0, kCodesKeep) == kPairs);
    REQUIRE(driver.after(60, {}, 10.0, kCodesKeep) == kSingle);
    CHECK(driver.after(100, sky, 1.0, kCodesKeep) == kSingle);
  }
}

TEST_CASE("a configured combination is never changed") {
  for (const CodeCombination configured : {kPairs, kSingle}) {
    Driver driver(configured);
    CHECK(driver.now() == configured);
    CHECK(driver.after(100, {}, 30.0, kCodesKeep) == configured);
    CHECK(driver.after(100, {}, 1.0, kCarriersKeep) == configured);
  }
}

TEST_CASE("without learning how large errors are, pairs stay") {
  constexpr bool kLearns = false;
  CHECK(Driver().after(300, {}, 30.0, kCodesKeep, kLearns) == kPairs);
}

}  // namespace
}  // namespace leonav
