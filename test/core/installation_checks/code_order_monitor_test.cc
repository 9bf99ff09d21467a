// Codes of two bands, the right way round or not, by the ionosphere.
#include "core/installation_checks/internal/code_order_monitor.h"

#include <cmath>

#include "support/catch.h"

namespace {

using namespace leonav;

// Twelve LEO satellites (no group delays) between 15 and 80 degrees; the ionosphere delays L1 at
// the zenith by `zenith_m`, the receiver the second band by 9 m.
ConventionFinding found_in_codes(double zenith_m, int epochs, double noise_m = 0.3) {
  const EphemerisStore ephemeris_store{EphemerisConfig()};
  CodeOrderMonitor check;
  RawEpoch raw;
  MeasurementEpoch seen;
  const BandPlan bands;
  const double f1 = bands.frequency_hz(System::kLeo, '1'),
               f2 = bands.frequency_hz(System::kLeo, '2');
  const double gamma = f1 * f1 / (f2 * f2);
  for (int n = 0; n < epochs; ++n) {
    raw.time = GpsTime::from_week_and_tow(2200, 1000.0 + n);
    raw.observations.clear();
    seen.satellites.clear();
    for (int i = 0; i < 12; ++i) {
      SatelliteInView satellite;
      satellite.satellite = {System::kLeo, static_cast<std::uint16_t>(i + 1)};
      satellite.elevation = 0.26 + 0.1 * i;
      const double sine = 0.94 * std::cos(satellite.elevation);
      const double delay_m = zenith_m / std::sqrt(1.0 - sine * sine);
      seen.satellites.push_back(satellite);
      SignalObservation first, second;
      first.satellite = second.satellite = satellite.satellite;
      first.code = {'1', 'C'};
      second.code = {'2', 'W'};
      first.pseudorange_m = 1.2e6 + delay_m + noise_m * std::sin(5.0 * n + i);
      second.pseudorange_m = 1.2e6 + gamma * delay_m + 9.0 + noise_m * std::cos(3.0 * n + 2.0 * i);
      raw.observations.push_back(first);
      raw.observations.push_back(second);
    }
    check.add(raw, seen, ephemeris_store);
  }
  return check.evaluate();
}

TEST_CASE("codes in order: no word", "[conventions]") {
  CHECK(!found_in_codes(3.0, 60));
  CHECK(!found_in_codes(0.0, 60));
}

TEST_CASE("codes exchanged show the ionosphere upside down", "[conventions]") {
  const auto finding = found_in_codes(-3.0, 60);
  CHECK(finding.convention == Convention::kCodesExchanged);
  CHECK(finding.value == Approx(3.0).margin(0.3));
}

TEST_CASE("a few epochs, or hardly any ionosphere, say nothing of the codes", "[conventions]") {
  CHECK(!found_in_codes(-3.0, 10));
  CHECK(!found_in_codes(-0.2, 60));
}

}  // namespace
