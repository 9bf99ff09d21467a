// SatelliteFaultMonitor's verdicts on drawn innovations: noise, noise that lasts, and a drift.
#include "core/navigator/monitors/satellite_fault_monitor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "begin_of_week.h"
#include "support/catch.h"

namespace leonav {
namespace {

SatelliteId satellite(int number) { return {System::kGps, static_cast<std::uint16_t>(number)}; }

struct Convicted {
  SatelliteFault fault;
  double after_s = 0.0;
};

// Seconds of carriers with white or lasting noise of `noise_m` and a common clock; `drift` adds to
// the innovation of a satellite at a time. The filter follows a tenth of each.
struct Run {
  int satellites = 8;
  double begin_s = 0.0, seconds = 600.0, interval_s = 1.0;
  double noise_m = 0.01, correlation_s = 0.0;
  std::function<double(int, double)> drift = [](int, double) { return 0.0; };
  std::function<bool(int, double)> seen = [](int, double) { return true; };
};

std::vector<Convicted> convictions(const Run& run, SatelliteFaultMonitor* monitor) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::vector<Convicted> found;
  std::vector<double> errors(static_cast<std::size_t>(run.satellites) + 1, 0.0);
  const double keep = run.correlation_s > 0.0 ? std::exp(-run.interval_s / run.correlation_s) : 0.0;
  for (double t = run.begin_s; t < run.seconds; t += run.interval_s) {
    const GpsTime time = test::kBeginOfWeek.plus_seconds(t);
    const ExcludedSatellites excluded = monitor->excluded(time);
    const double clock = 3.0 * normal(generator);
    CarrierInnovations carriers;
    for (int i = 1; i <= run.satellites; ++i) {
      double& error = errors[static_cast<std::size_t>(i)];
      error = keep * error + std::sqrt(1.0 - keep * keep) * run.noise_m * normal(generator);
      const bool out = std::find(excluded.begin(), excluded.end(), satellite(i)) != excluded.end();
      if (out || !run.seen(i, t)) continue;
      const double innovation = clock + error + run.drift(i, t);
      carriers.push_back({satellite(i), SignalCode(), innovation, 0.9 * innovation, 0.003});
    }
    if (const auto fault = monitor->add(carriers, time)) found.push_back({*fault, t});
  }
  return found;
}

TEST_CASE("noise convicts no satellite, neither white nor lasting for ten seconds") {
  for (const double correlation_s : {0.0, 3.0, 10.0}) {
    CAPTURE(correlation_s);
    SatelliteFaultMonitor monitor;
    Run run;
    run.seconds = 7200.0;
    run.correlation_s = correlation_s;
    CHECK(convictions(run, &monitor).empty());
  }
}

TEST_CASE(
    "a satellite whose innovations keep one sign is convicted and left out for half an hour") {
  for (const double interval_s : {0.2, 1.0, 5.0}) {
    CAPTURE(interval_s);
    SatelliteFaultMonitor monitor;
    Run run;
    run.interval_s = interval_s;
    run.seconds =
        1800.0 + 300.0 * std::max(interval_s, 1.0);  // it is not used again before the end
    const double begin_s = 300.0 * std::max(interval_s, 1.0);
    run.drift = [&](int i, double t) { return i == 3 && t >= begin_s ? 0.05 : 0.0; };
    const auto found = convictions(run, &monitor);
    REQUIRE(found.size() == 1);
    CHECK(found[0].fault.satellite == satellite(3));
    CHECK(found[0].after_s > begin_s);
    CHECK(found[0].after_s < begin_s + 250.0 * std::max(interval_s, 1.0));
    // A tenth of each innovation, less what has faded of it.
    const double all_m = 0.1 * 0.05 * (found[0].after_s - begin_s) / interval_s;
    CHECK(found[0].fault.followed_m > 0.6 * all_m);
    CHECK(found[0].fault.followed_m < 1.2 * all_m);
    const GpsTime time = test::kBeginOfWeek.plus_seconds(found[0].after_s);
    CHECK(monitor.excluded(time.plus_seconds(1799.0)).size() == 1);
    CHECK(monitor.excluded(time.plus_seconds(1801.0)).empty());
  }
}

TEST_CASE("a single large innovation convicts nobody") {
  SatelliteFaultMonitor monitor;
  Run run;
  run.drift = [](int i, double t) { return i == 3 && t == 300.0 ? 1000.0 : 0.0; };
  CHECK(convictions(run, &monitor).empty());
}

TEST_CASE("too few satellites convict nobody, nor do they lose more than one in four") {
  SatelliteFaultMonitor few;
  Run run;
  run.satellites = 5;
  run.drift = [](int i, double t) { return i == 3 && t >= 100.0 ? 0.05 : 0.0; };
  CHECK(convictions(run, &few).empty());
  SatelliteFaultMonitor many;
  run.satellites = 9;
  run.seconds = 1800.0;
  run.drift = [](int i, double t) { return i <= 3 && t >= 100.0 ? 0.05 * i : 0.0; };
  const std::size_t convicted = convictions(run, &many).size();
  CHECK(convicted >= 1);
  CHECK(convicted <= 2);
  CHECK(many.excluded(test::kBeginOfWeek.plus_seconds(1500.0)).size() <= 2);
}

TEST_CASE("a restart of the filter clears the sums, and a new time base the exclusions too") {
  SatelliteFaultMonitor monitor;
  Run run;
  run.drift = [](int i, double t) { return i == 3 && t >= 100.0 ? 0.05 : 0.0; };
  const auto found = convictions(run, &monitor);
  REQUIRE(found.size() == 1);
  const double convicted_s = found[0].after_s;
  monitor.filter_restarted(false);
  CHECK(monitor.excluded(test::kBeginOfWeek.plus_seconds(600.0)).size() == 1);
  monitor.filter_restarted(true);
  CHECK(monitor.excluded(test::kBeginOfWeek.plus_seconds(600.0)).empty());
  // Restarted just before it would convict, it takes its time again.
  for (const bool restarted : {false, true}) {
    CAPTURE(restarted);
    SatelliteFaultMonitor other;
    run.begin_s = 0.0, run.seconds = convicted_s;
    REQUIRE(convictions(run, &other).empty());
    if (restarted) other.filter_restarted(false);
    run.begin_s = convicted_s, run.seconds = convicted_s + 80.0;
    CHECK(convictions(run, &other).empty() == restarted);
  }
}

TEST_CASE("a satellite that has gone is not convicted when others come") {
  // Of eight satellites one may be left out, 1, and not the second that drifts, 2. At 500 s that
  // one goes and four come, so that another might be left out.
  Run run;
  run.satellites = 12;
  run.seconds = 700.0;
  run.drift = [](int i, double t) { return i <= 2 && t >= 100.0 ? 0.1 / i : 0.0; };
  run.seen = [](int i, double t) { return t < 500.0 ? i <= 8 : i != 2; };
  SatelliteFaultMonitor monitor;
  const auto found = convictions(run, &monitor);
  REQUIRE(found.size() == 1);
  CHECK(found[0].fault.satellite == satellite(1));
  // While it is there it is convicted as soon as the others have come.
  run.seen = [](int i, double t) { return t >= 500.0 || i <= 8; };
  SatelliteFaultMonitor other;
  CHECK(convictions(run, &other).size() == 2);
}

TEST_CASE("what few carriers show does not count later") {
  SatelliteFaultMonitor monitor;
  Run run;
  run.satellites = 4;
  run.seconds = 400.0;
  run.drift = [](int i, double) { return i == 3 ? 0.05 : 0.0; };
  CHECK(convictions(run, &monitor).empty());
  run.satellites = 8;
  run.begin_s = 400.0, run.seconds = 1000.0;
  run.drift = [](int, double) { return 0.0; };
  CHECK(convictions(run, &monitor).empty());
}

}  // namespace
}  // namespace leonav
