#include "tools/quality/internal/census.h"

#include <memory>

#include "support/catch.h"
#include "support/start_time.h"
#include "tools/quality/internal/code_steps.h"
#include "tools/quality/internal/distribution.h"

using namespace leonav;

namespace {

SignalObservation signal(SatelliteId satellite, const char* code) {
  SignalObservation o;
  o.satellite = satellite;
  o.code = *signal_from_string(code);
  o.pseudorange_m = 2.2e7;
  o.carrier_cycles = 1.1e8;
  return o;
}

}  // namespace

TEST_CASE("times: interval, gaps, missing and late epochs") {
  Census census(default_gnss_config());
  auto epoch = std::make_unique<RawEpoch>();
  // Two holes: one epoch at 3, four epochs from 7 to 10. One that goes back.
  for (const double t : {0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 6.0, 11.0, 12.001}) {
    epoch->time = test::kAnyTime.plus_seconds(t);
    census.add(*epoch);
  }
  const EpochTimes times = census.times();
  CHECK(times.epochs == 8);
  CHECK(times.backwards == 1);
  CHECK(times.interval_s == 1.0);
  CHECK(times.gaps == 2);
  CHECK(times.missing == 5.0);
  CHECK(times.longest_gap_s == 5.0);
}

TEST_CASE("an epoch alone, and epochs less than a millisecond apart, have no gaps") {
  Census census(default_gnss_config());
  RawEpoch epoch;
  for (const double t : {0.0, 0.0001, 0.0002, 5.0}) {
    epoch.time = test::kAnyTime.plus_seconds(t);
    census.add(epoch);
    CHECK(census.times().gaps == 0);
  }
}

TEST_CASE("carriers are paired as the navigator would, by what is there most often") {
  Census census(default_gnss_config());
  const SatelliteId all{System::kGps, 1}, rare{System::kGps, 2}, alone{System::kGps, 3};
  const SatelliteId wide{System::kBeidou, 21};
  RawEpoch epoch;
  for (int k = 0; k < 100; ++k) {
    epoch.time = test::kAnyTime.plus_seconds(k);
    epoch.observations.clear();
    for (const char* code : {"1C", "1W", "2L", "2W", "5Q"})
      epoch.observations.push_back(signal(all, code));
    epoch.observations.push_back(signal(rare, "1C"));
    if (k < 20) epoch.observations.push_back(signal(rare, "2W"));
    if (k < 95) epoch.observations.push_back(signal(rare, "5Q"));
    epoch.observations.push_back(signal(alone, "1C"));
    for (const char* code : {"5P", "6I"}) epoch.observations.push_back(signal(wide, code));
    census.add(epoch);
  }
  const auto plans = census.plans();
  CHECK(to_string(plans.at(all).reference) == "1C");
  REQUIRE(plans.at(all).others.size() == 2);
  CHECK(to_string(plans.at(all).others[0]) == "2W");
  CHECK(to_string(plans.at(all).others[1]) == "5Q");
  CHECK(to_string(plans.at(rare).others.at(0)) == "5Q");
  CHECK(to_string(plans.at(rare).others.at(1)) == "2W");
  CHECK(plans.at(alone).others.empty());
  // No combination of the two is useful to the navigator; they are paired all the same.
  CHECK(to_string(plans.at(wide).reference) == "6I");
  CHECK(to_string(plans.at(wide).others.at(0)) == "5P");
}

TEST_CASE("a step that all codes share is taken out, one satellite's is not") {
  CodeSteps steps{BandPlan()};
  RawEpoch epoch;
  double offset_m = 0.0;
  for (int k = 0; k < 60; ++k) {
    if (k == 20) offset_m += 30.0;
    if (k == 40) offset_m -= 45.0;
    epoch.time = test::kAnyTime.plus_seconds(k);
    epoch.observations.clear();
    for (std::uint16_t number = 1; number <= 8; ++number) {
      SignalObservation o = signal({System::kGps, number}, "1C");
      const double range_m = 2.2e7 + 300.0 * k * number;
      o.carrier_cycles = (range_m + 5.0e6) / wavelength_m(System::kGps, '1');
      o.pseudorange_m = range_m + offset_m + (number == 3 && k >= 30 ? 100.0 : 0.0) +
                        3.0 * std::sin(1.7 * k + number);
      epoch.observations.push_back(o);
    }
    steps.repair(&epoch);
    for (const SignalObservation& o : epoch.observations) {
      const double range_m = 2.2e7 + 300.0 * k * o.satellite.number;
      const double own_m = o.satellite.number == 3 && k >= 30 ? 100.0 : 0.0;
      // A median of eight with 3 m of noise is known to some metres.
      CHECK(std::abs(o.pseudorange_m - range_m - own_m) < 12.0);
    }
  }
  CHECK(steps.count() == 2);
}

TEST_CASE("C/N0: mean and percentiles of cells are those of the values") {
  Cn0Distribution cn0;
  for (int i = 1; i <= 100; ++i) cn0.add(0.5 * i);
  cn0.add(std::nan(""));
  CHECK(cn0.count() == 100);
  CHECK(cn0.mean() == Approx(25.25));
  CHECK(cn0.percentile(0.05) == Approx(2.5));
  CHECK(cn0.percentile(0.5) == Approx(25.0));
  CHECK(cn0.percentile(0.95) == Approx(47.5));
  CHECK(std::isnan(Cn0Distribution().percentile(0.5)));
  CHECK(std::isnan(Cn0Distribution().mean()));
}
