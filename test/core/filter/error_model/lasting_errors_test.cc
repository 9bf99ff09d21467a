// Errors that last for minutes, as those of wrong orbits, are told from reflections.
#include "core/filter/error_model/lasting_errors.h"

#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "support/catch.h"
#include "support/start_time.h"

using namespace leonav;

namespace {

struct Street {
  int satellites = 8;  // of each system
  double white_m = 1.0, reflected_m = 3.0, reflected_s = 20.0;
  double speed_m_s = 10.0, interval_s = 1.0;
  std::vector<System> systems = {System::kGps};
};
using Bias = std::function<double(SatelliteId, double t)>;  // m

// Draws codes and asks `each` after every epoch; it returns whether to go on.
void run(const Street& street, double duration_s, const Bias& bias, std::uint64_t seed,
         const std::function<bool(const LastingErrors&, double t)>& each, double stated_m = 0.05) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double r = std::exp(-street.interval_s / street.reflected_s);
  LastingErrors errors;
  std::vector<double> reflections;
  for (double t = 0.0; t < duration_s; t += street.interval_s) {
    std::size_t k = 0;
    for (const System system : street.systems)
      for (int i = 1; i <= street.satellites; ++i, ++k) {
        if (reflections.size() <= k) reflections.push_back(street.reflected_m * normal(random));
        double& reflection = reflections[k];
        reflection = r * reflection + std::sqrt(1.0 - r * r) * street.reflected_m * normal(random);
        LastingErrors::Sample sample;
        sample.satellite = {system, static_cast<std::uint16_t>(i)};
        sample.redundancy = 0.5;
        sample.residual_m = std::sqrt(0.5) * (bias(sample.satellite, t) + reflection +
                                              street.white_m * normal(random));
        sample.stated_variance = stated_m * stated_m;
        sample.speed_m_s = street.speed_m_s;
        errors.add(sample, test::kAnyTime.plus_seconds(t));
      }
    errors.end_epoch(test::kAnyTime.plus_seconds(t));
    if (!each(errors, t)) return;
  }
}

double alternating(SatelliteId satellite, double size_m) {
  return satellite.number % 2 == 0 ? size_m : -size_m;
}

// Returns after how many seconds an error of `system` is found; the duration: never.
double found_after(const Street& street, double duration_s, const Bias& bias, std::uint64_t seed,
                   System system = System::kGps, double stated_m = 0.05) {
  double after_s = duration_s;
  run(
      street, duration_s, bias, seed,
      [&](const LastingErrors& errors, double t) {
        if (errors.sigma_m(system) > 0.0) after_s = std::min(after_s, t);
        return after_s == duration_s;
      },
      stated_m);
  return after_s;
}

const Bias kNone = [](SatelliteId, double) { return 0.0; };

}  // namespace

TEST_CASE("reflections of driving, walking and standing are not taken for wrong orbits") {
  // Speed, and how long a reflection lasts then.
  const auto [speed_m_s, reflected_s] = GENERATE(std::pair(10.0, 20.0), std::pair(1.4, 60.0),
                                                 std::pair(1.4, 120.0), std::pair(0.0, 600.0));
  CAPTURE(speed_m_s, reflected_s);
  Street street;
  street.speed_m_s = speed_m_s;
  street.reflected_s = reflected_s;
  const double duration_s = speed_m_s > 5.0 ? 3600.0 : 4.0 * 3600.0;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    found += found_after(street, duration_s, kNone, seed) < duration_s ? 1 : 0;
  CHECK(found == 0);
}

TEST_CASE("biases of ten metres are found within minutes, with their size") {
  const Bias bias = [](SatelliteId satellite, double) { return alternating(satellite, 10.0); };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CHECK(found_after(Street(), 3600.0, bias, seed) < 300.0);
    double sigma_m = 0.0;
    run(Street(), 600.0, bias, seed, [&](const LastingErrors& errors, double) {
      sigma_m = errors.sigma_m(System::kGps);
      return true;
    });
    // Eight satellites count as four.
    CHECK(sigma_m == Approx(10.0 * std::sqrt(2.0)).epsilon(0.25));
  }
}

TEST_CASE("a standing vehicle takes longer to find them") {
  Street street;
  street.speed_m_s = 0.0;
  street.reflected_s = 300.0;
  street.interval_s = GENERATE(1.0, 30.0);
  CAPTURE(street.interval_s);
  const Bias bias = [](SatelliteId satellite, double) { return alternating(satellite, 20.0); };
  const double after_s = found_after(street, 4.0 * 3600.0, bias, 1);
  CHECK(after_s >= 3500.0);
  CHECK(after_s < 8000.0);
}

TEST_CASE("biases within what is stated, or of two satellites only, are no finding") {
  const Bias all = [](SatelliteId satellite, double) { return alternating(satellite, 3.0); };
  Street open_sky;
  open_sky.reflected_m = 0.3;
  CHECK(found_after(open_sky, 1800.0, all, 1) < 300.0);
  CHECK(found_after(open_sky, 1800.0, all, 1, System::kGps, 1.0) == 1800.0);
  const Bias two = [](SatelliteId satellite, double) { return satellite.number <= 2 ? 30.0 : 0.0; };
  CHECK(found_after(open_sky, 1800.0, two, 1) == 1800.0);
}

TEST_CASE("a satellite that moves its system's clock makes no system wrong") {
  Street open_sky;
  open_sky.satellites = GENERATE(4, 5, 8);
  open_sky.reflected_m = 0.3;
  // One is 20 m off, and the clock takes its share of that.
  const double n = open_sky.satellites;
  const Bias bias = [n](SatelliteId satellite, double) {
    return (satellite.number == 1 ? 20.0 : 0.0) - 20.0 / n;
  };
  CHECK(found_after(open_sky, 1800.0, bias, 1) == 1800.0);
}

TEST_CASE("right orbits end a finding, wrong ones keep it") {
  const Bias mended = [](SatelliteId satellite, double t) {
    return t < 600.0 ? alternating(satellite, 20.0) : 0.0;
  };
  bool at_500 = false, at_800 = false, at_1400 = true;
  run(Street(), 1401.0, mended, 3, [&](const LastingErrors& errors, double t) {
    if (t == 500.0) at_500 = errors.sigma_m(System::kGps) > 0.0;
    if (t == 800.0) at_800 = errors.sigma_m(System::kGps) > 0.0;
    if (t == 1400.0) at_1400 = errors.sigma_m(System::kGps) > 0.0;
    return true;
  });
  CHECK(at_500);
  CHECK(at_800);  // it may be chance
  CHECK_FALSE(at_1400);
  const Bias wrong = [](SatelliteId satellite, double) { return alternating(satellite, 20.0); };
  bool kept = true;
  run(Street(), 1800.0, wrong, 3, [&](const LastingErrors& errors, double t) {
    if (t > 300.0) kept = kept && errors.sigma_m(System::kGps) > 0.0;
    return true;
  });
  CHECK(kept);
}

TEST_CASE("where most systems are wrong the others are taken for wrong too") {
  Street street;
  street.systems = {System::kGps, System::kGalileo, System::kBeidou};
  const auto of = [](std::vector<System> wrong) {
    return [wrong](SatelliteId satellite, double) {
      for (const System system : wrong)
        if (satellite.system == system) return alternating(satellite, 10.0);
      return 0.0;
    };
  };
  CHECK(found_after(street, 1200.0, of({System::kGps, System::kGalileo}), 1, System::kBeidou) <
        300.0);
  CHECK(found_after(street, 1200.0, of({System::kGps}), 1, System::kBeidou) == 1200.0);
  CHECK(found_after(street, 1200.0, of({System::kGps}), 1, System::kGps) < 300.0);
}

TEST_CASE("low orbits that are wrong from the start do not make GPS wrong, which takes longer") {
  Street street;
  street.systems = {System::kGps, System::kLeo};
  street.speed_m_s = GENERATE(0.0, 10.0);
  street.reflected_m = 0.3;
  CAPTURE(street.speed_m_s);
  const Bias of_leo = [](SatelliteId satellite, double) {
    return satellite.system == System::kLeo ? alternating(satellite, 10.0) : 0.0;
  };
  CHECK(found_after(street, 1200.0, of_leo, 1, System::kLeo) < 60.0);
  CHECK(found_after(street, 1200.0, of_leo, 1, System::kGps) == 1200.0);
}

TEST_CASE("after a gap a single code is no block, and after a long one nothing is left") {
  // One bad code of each satellite after each gap, then blocks of them, then a gap again.
  for (const double gap_s : {61.0, 400.0, 1000.0}) {
    CAPTURE(gap_s);
    LastingErrors errors;
    double t = 0.0;
    const auto add = [&](double residual_m) {
      for (std::uint16_t i = 1; i <= 4; ++i)
        errors.add({{System::kGps, i}, alternating({System::kGps, i}, residual_m), 1.0, 1e-4, 20.0},
                   test::kAnyTime.plus_seconds(t));
      errors.end_epoch(test::kAnyTime.plus_seconds(t));
    };
    for (int gap = 0; gap < 8; ++gap, t += gap_s) add(50.0);
    CHECK(errors.largest_sigma_m() == 0.0);
    for (const double end = t + 300.0; t < end; t += 1.0) add(50.0);
    CHECK(errors.largest_sigma_m() > 0.0);
    t += gap_s;
    add(0.0);
    CHECK((errors.largest_sigma_m() > 0.0) == (gap_s < 600.0));
  }
}

TEST_CASE("the growth of an error is reported, also after it has become smaller in between") {
  LastingErrors errors;
  double t = 0.0;
  // Returns the root of the sum of squares of what L has grown by.
  const auto drive = [&](double size_m) {
    double sum = 0.0;
    for (const double end = t + 900.0; t < end; t += 1.0) {
      for (std::uint16_t i = 1; i <= 4; ++i) {
        const SatelliteId satellite{System::kGps, i};
        errors.add({satellite, alternating(satellite, size_m), 1.0, 1e-4, 10.0},
                   test::kAnyTime.plus_seconds(t));
      }
      errors.end_epoch(test::kAnyTime.plus_seconds(t));
      sum += errors.change().growth_m * errors.change().growth_m;
      if (errors.change().growth_m > 0.0) CHECK(errors.change().codes_differ);
    }
    return std::sqrt(sum);
  };
  CHECK(drive(0.0) == 0.0);
  const double grown_m = drive(10.0);
  CHECK(grown_m > 6.0);
  CHECK(grown_m <= 10.0);
  CHECK(drive(10.0) == 0.0);
  CHECK(drive(12.0) == 0.0);
  CHECK(drive(3.0) < 3.5);   // at most 3 m, if the step down passes for the end of the error
  CHECK(drive(12.0) > 8.0);  // though it has been as bad before
  bool differ = false;
  for (const double end = t + 900.0; t < end; t += 1.0) {
    for (std::uint16_t i = 1; i <= 4; ++i)
      errors.add({{System::kGps, i}, 0.0, 1.0, 1e-4, 10.0}, test::kAnyTime.plus_seconds(t));
    errors.end_epoch(test::kAnyTime.plus_seconds(t));
    differ |= errors.change().codes_differ;
  }
  CHECK(differ);
  CHECK(errors.largest_sigma_m() == 0.0);
}

TEST_CASE("a finding counts the satellites in view, and ends when none can be tested") {
  // Sixteen satellites, of which twelve set at 600 s, the others at 1200 s.
  LastingErrors errors;
  const auto add = [&errors](int satellites, double from_s, double to_s) {
    for (double t = from_s; t < to_s; t += 1.0) {
      for (int i = 1; i <= satellites; ++i) {
        const SatelliteId satellite{System::kGps, static_cast<std::uint16_t>(i)};
        errors.add({satellite, alternating(satellite, 5.0), 0.25, 1e-4, 10.0},
                   test::kAnyTime.plus_seconds(t));
      }
      errors.end_epoch(test::kAnyTime.plus_seconds(t));
    }
  };
  add(16, 0.0, 600.0);
  CHECK(errors.own_sigma_m(System::kGps) == Approx(10.0));
  CHECK(errors.sigma_m(System::kGps) == Approx(20.0));
  CHECK(errors.sigma_m(System::kLeo) == Approx(20.0));  // all that can be tested are wrong
  CHECK(errors.own_sigma_m(System::kLeo) == 0.0);
  add(4, 600.0, 1200.0);
  CHECK(errors.sigma_m(System::kGps) == Approx(10.0));
  add(0, 1200.0, 1500.0);
  CHECK(errors.sigma_m(System::kGps) > 0.0);
  add(0, 1500.0, 2100.0);
  CHECK(errors.sigma_m(System::kGps) == 0.0);
  CHECK(errors.sigma_m(System::kLeo) == 0.0);
}

TEST_CASE("an error is found once, when it has doubled, and when it comes back") {
  LastingErrors errors;
  double t = 0.0, largest_m = 0.0;
  // Four satellites of GPS and of Galileo, off by these. Returns how often something is found.
  const auto drive = [&](double seconds, double gps_m, double galileo_m) {
    int found = 0;
    for (const double end = t + seconds; t < end; t += 1.0) {
      for (std::uint16_t i = 1; i <= 4; ++i) {
        const SatelliteId gps{System::kGps, i}, galileo{System::kGalileo, i};
        errors.add({gps, alternating(gps, gps_m), 1.0, 1e-4, 10.0}, test::kAnyTime.plus_seconds(t));
        errors.add({galileo, alternating(galileo, galileo_m), 1.0, 1e-4, 10.0},
                   test::kAnyTime.plus_seconds(t));
      }
      errors.end_epoch(test::kAnyTime.plus_seconds(t));
      if (errors.change().found_m == 0.0) continue;
      ++found;
      largest_m = errors.change().found_m;
    }
    return found;
  };
  CHECK(drive(600.0, 0.0, 0.0) == 0);
  CHECK(drive(600.0, 5.0, 9.0) >= 1);
  CHECK(largest_m > 4.0);
  CHECK(drive(600.0, 5.0, 9.0) == 0);
  CHECK(drive(900.0, 5.0, 40.0) >= 1);
  CHECK(largest_m > 18.0);
  CHECK(drive(900.0, 0.0, 0.0) == 0);
  CHECK(errors.largest_sigma_m() == 0.0);
  CHECK(drive(600.0, 5.0, 0.0) >= 1);
}

TEST_CASE("errors of low orbits are found though they change along the pass") {
  Street street;
  street.systems = {System::kLeo};
  street.satellites = 6;
  street.reflected_s = 4.0;
  street.reflected_m = 1.0;
  const Bias bias = [](SatelliteId satellite, double t) {
    return (20.0 + 0.1 * t) * (satellite.number % 2 == 0 ? 1.0 : -1.0);
  };
  CHECK(found_after(street, 300.0, bias, 1, System::kLeo) < 120.0);
}
