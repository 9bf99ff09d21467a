// Codes against Dopplers: sign, unit, band.
#include "core/installation_checks/internal/range_rate_monitor.h"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/catch.h"

namespace {

using namespace leonav;

constexpr double kInterval_s = 1.0;

// Six GPS satellites on L1 and L2, ranges of constant rates; a clock that drifts and steps.
RawEpoch epoch_at(int n) {
  RawEpoch epoch;
  epoch.time = GpsTime::from_nanoseconds(1'300'000'000'000'000'000).plus_seconds(n * kInterval_s);
  const double clock_m = 50.0 * n - (n / 5) * 3e5;
  for (int i = 0; i < 6; ++i) {
    const double rate = -600.0 + 230.0 * i;
    for (const SignalCode code : {SignalCode{'1', 'C'}, SignalCode{'2', 'W'}}) {
      SignalObservation observation;
      observation.satellite = {System::kGps, static_cast<std::uint16_t>(i + 1)};
      observation.code = code;
      observation.pseudorange_m = 2.2e7 + rate * n + clock_m + std::sin(7.0 * n + i);
      observation.doppler_hz = -(rate + 50.0) / wavelength_m(System::kGps, code.band);
      epoch.observations.push_back(observation);
    }
  }
  return epoch;
}

template <typename Change>
RangeRateMonitor after(int epochs, Change change) {
  RangeRateMonitor check;
  for (int n = 0; n < epochs; ++n) {
    RawEpoch epoch = epoch_at(n);
    for (SignalObservation& observation : epoch.observations) change(&observation);
    check.add(epoch);
  }
  return check;
}

TEST_CASE("right Dopplers, whatever the clock does", "[conventions]") {
  const RangeRateMonitor check = after(30, [](SignalObservation*) {});
  CHECK(check.is_right());
  CHECK(!check.evaluate());
}

TEST_CASE("a few epochs say nothing of Dopplers", "[conventions]") {
  const RangeRateMonitor check = after(5, [](SignalObservation* o) { o->doppler_hz *= -1.0; });
  CHECK(!check.is_right());
  CHECK(!check.evaluate());
}

TEST_CASE("Dopplers of the wrong sign or unit", "[conventions]") {
  const auto negative = after(30, [](SignalObservation* o) { o->doppler_hz *= -1.0; });
  CHECK(negative.evaluate().convention == Convention::kDopplerSign);
  CHECK(!negative.is_right());
  const auto in_m_s = after(
      30, [](SignalObservation* o) { o->doppler_hz *= -wavelength_m(System::kGps, o->code.band); });
  CHECK(in_m_s.evaluate().convention == Convention::kDopplerUnit);
}

TEST_CASE("signals that have each other's names", "[conventions]") {
  const auto check = after(30, [](SignalObservation* o) {
    // What is called L1 has the Doppler of L2, and the other way round.
    const double f1 = frequency_hz(System::kGps, '1'), f2 = frequency_hz(System::kGps, '2');
    o->doppler_hz *= o->code.band == '1' ? f2 / f1 : f1 / f2;
  });
  CHECK(check.evaluate().convention == Convention::kSignalsExchanged);
  CHECK(std::abs(check.evaluate().value - 1.28) < 0.02);
}

TEST_CASE("one band is enough to see that its name is another's", "[conventions]") {
  // A phone measures L1 of all satellites, L5 of too few; here L1 is called L5.
  const auto exchanged = [](bool misnamed) {
    return [misnamed](SignalObservation* o) {
      const bool few = o->code.band == '2';
      if (few)
        o->doppler_hz = kNotMeasured;
      else if (misnamed)
        o->code = {'5', 'X'};
    };
  };
  CHECK(!after(30, exchanged(false)).evaluate());
  const ConventionFinding finding = after(30, exchanged(true)).evaluate();
  CHECK(finding.convention == Convention::kSignalsExchanged);
  CHECK(finding.value == Approx(0.747).margin(0.005));
}

TEST_CASE("beside a system in order the exchanged one is told, with its own factor",
          "[conventions]") {
  RangeRateMonitor check;
  for (int n = 0; n < 30; ++n) {
    RawEpoch epoch = epoch_at(n);
    const RawEpoch right = epoch;
    for (SignalObservation o : right.observations) {
      o.satellite.system = System::kLeo;
      const BandPlan bands;
      const double f1 = bands.frequency_hz(System::kLeo, '1'),
                   f2 = bands.frequency_hz(System::kLeo, '2');
      o.doppler_hz *= o.code.band == '1' ? f2 / f1 : f1 / f2;
      epoch.observations.push_back(o);
    }
    check.add(epoch);
  }
  CHECK(check.evaluate().convention == Convention::kSignalsExchanged);
  CHECK(check.evaluate().value == Approx(1.283).margin(0.01));
}

// Verdicts on right Dopplers whose codes are reflected: after a few epochs the factor of each of
// `bands`, Galileo's, is anywhere near one.
int told_of_wandering_codes(const std::vector<SignalCode>& bands) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> step_m(0.0, 85.0);
  int told = 0;
  for (int seed = 0; seed < 300; ++seed) {
    RangeRateMonitor check;
    std::array<std::array<double, 10>, 4> wander_m{};
    for (int n = 0; n < 30; ++n) {
      const RawEpoch whole = epoch_at(n);
      RawEpoch epoch;
      epoch.time = whole.time;
      for (std::size_t i = 0; i < wander_m.size(); ++i) {
        SignalObservation o = whole.observations[2 * i];  // of L1
        const double rate = -wavelength_m(System::kGps, '1') * o.doppler_hz;
        const double right_m = o.pseudorange_m;
        o.satellite.system = System::kGalileo;
        for (const SignalCode code : bands) {
          double& random_walk = wander_m[i][static_cast<std::size_t>(code.band - '0')];
          random_walk += step_m(random);
          o.code = code;
          o.pseudorange_m = right_m + random_walk;
          o.doppler_hz = -rate / wavelength_m(System::kGalileo, code.band);
          epoch.observations.push_back(o);
        }
      }
      check.add(epoch);
      if (!check.evaluate()) continue;
      ++told;
      break;
    }
  }
  return told;
}

TEST_CASE("right bands whose codes wander are not taken for wrong ones", "[conventions]") {
  CHECK(told_of_wandering_codes({{'1', 'C'}}) == 0);
  CHECK(told_of_wandering_codes({{'5', 'Q'}, {'6', 'C'}}) == 0);  // 8 % apart
}

TEST_CASE("bands that lie close together: a right one has not the name of another",
          "[conventions]") {
  // Galileo's E5a called so, its codes 7 % slow: within what counts as right, and near E6's ratio.
  const auto check = after(30, [](SignalObservation* o) {
    const double rate = -wavelength_m(System::kGps, o->code.band) * o->doppler_hz;
    const bool first = o->code.band == '1';
    o->satellite.system = System::kGalileo;
    o->code = {first ? '5' : '7', 'Q'};
    o->doppler_hz = first ? -1.08 * rate / wavelength_m(System::kGalileo, '5') : kNotMeasured;
  });
  CHECK(check.is_right());
  CHECK(!check.evaluate());
}

TEST_CASE("bands that contradict each other tell neither sign nor unit", "[conventions]") {
  const auto check = after(30, [](SignalObservation* o) {
    if (o->code.band == '2') o->doppler_hz *= -1.0;
  });
  CHECK(!check.evaluate());
}

TEST_CASE("nothing measured, nothing said", "[conventions]") {
  const auto check = after(30, [](SignalObservation* o) { o->doppler_hz = kNotMeasured; });
  CHECK(!check.is_right());
  CHECK(!check.evaluate());
}

}  // namespace
