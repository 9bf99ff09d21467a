#include "core/navigator/monitors/orbit_error_monitor.h"

#include <cmath>

#include "support/catch.h"

using namespace leonav;

namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2200, 1000.0);

// Four satellites of each system, whose codes are off by these, m.
struct Sky {
  double t = 0.0;
  LastingErrors errors;
  OrbitErrorMonitor monitor;
  // Returns how often something is reported within `seconds`; `largest_m` is the last report.
  int drive(double seconds, double gps_m, double galileo_m, double* largest_m) {
    int told = 0;
    for (const double end = t + seconds; t < end; t += 1.0) {
      for (int i = 1; i <= 4; ++i) {
        const double sign = i % 2 == 0 ? 1.0 : -1.0;
        const auto number = static_cast<std::uint16_t>(i);
        errors.add({{System::kGps, number}, sign * gps_m, 1.0, 1e-4, 10.0}, at());
        errors.add({{System::kGalileo, number}, sign * galileo_m, 1.0, 1e-4, 10.0}, at());
      }
      errors.end_epoch(at());
      const auto finding = monitor.add(errors);
      if (!finding) continue;
      ++told;
      *largest_m = *finding;
    }
    return told;
  }
  GpsTime at() const { return kStart.plus_seconds(t); }
};

}  // namespace

TEST_CASE("an orbit error is reported once, when it has doubled, and when it comes back") {
  Sky sky;
  double sigma_m = 0.0;
  CHECK(sky.drive(600.0, 0.0, 0.0, &sigma_m) == 0);
  CHECK(sky.drive(600.0, 0.0, 5.0, &sigma_m) == 1);
  CHECK(sigma_m > 2.0);
  CHECK(sky.drive(600.0, 0.0, 7.0, &sigma_m) <= 1);  // found while the mean was still growing
  CHECK(sky.drive(900.0, 0.0, 40.0, &sigma_m) >= 1);
  CHECK(sigma_m > 10.0);
  CHECK(sky.drive(600.0, 0.0, 0.0, &sigma_m) <= 1);
  CHECK(sky.errors.own_sigma_m(System::kGalileo) == 0.0);
  CHECK(sky.drive(600.0, 0.0, 5.0, &sigma_m) == 1);
}

TEST_CASE("systems that are found wrong together are one report, of the largest error") {
  Sky sky;
  double sigma_m = 0.0;
  CHECK(sky.drive(600.0, 5.0, 9.0, &sigma_m) == 1);
  CHECK(sigma_m == Approx(9.0));
}
