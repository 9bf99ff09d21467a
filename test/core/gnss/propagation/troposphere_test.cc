#include "core/gnss/propagation/troposphere.h"
#include "core/base/angle.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "support/catch.h"

namespace leonav {
namespace {

Geodetic at(double latitude_deg, double height) { return {latitude_deg * kDegree, 0.1, height}; }

}  // namespace

// RTKLIB's tropmodel at zenith with humidity 0, 0.5 and 0.7. Its standard atmosphere and ours
// round the constants of pressure differently and put the freezing point 0.01 K apart: below 1 mm.
TEST_CASE("Zenith delays agree with RTKLIB's", "[troposphere]") {
  struct Row {
    double latitude_deg, height, dry, half, humid;
  };
  for (const Row& row :
       {Row{55, 0, 2.304871, 2.390933, 2.425358}, Row{55, 50, 2.291270, 2.375638, 2.409385},
        Row{0, 1000, 2.052262, 2.109482, 2.132370}, Row{-35, 3000, 1.598945, 1.622496, 1.631916},
        Row{89, 9000, 0.699730, 0.700507, 0.700819}}) {
    INFO(row.latitude_deg << " deg, " << row.height << " m");
    const ZenithDelays half = saastamoinen_zenith_delays(at(row.latitude_deg, row.height), 0.5);
    const ZenithDelays humid = saastamoinen_zenith_delays(at(row.latitude_deg, row.height), 0.7);
    CHECK(half.hydrostatic_m == Approx(row.dry).margin(1e-3));
    CHECK(half.wet_m == Approx(row.half - row.dry).margin(1e-3));
    CHECK(humid.wet_m == Approx(row.humid - row.dry).margin(1e-3));
  }
}

// The value every textbook gives for 1013.25 hPa: 2.31 m of dry air at sea level.
TEST_CASE("Sea level has 2.3 m of dry air", "[troposphere]") {
  CHECK(saastamoinen_zenith_delays(at(45, 0)).hydrostatic_m ==
        Approx(0.0022768 * 1013.25).margin(1e-4));
}

TEST_CASE("Niell's mapping agrees with RTKLIB's", "[troposphere]") {
  struct Row {
    int week;
    double tow, latitude_deg, height, elevation_deg, hydrostatic, wet;
  };
  for (const Row& row : {Row{2111, 345600, 55.5, 50, 15, 3.799882811, 3.832722453},
                         Row{2111, 345600, 55.5, 50, 5, 10.123868832, 10.739110036},
                         Row{2140, 100000, -35, 2000, 10, 5.554665790, 5.658706736},
                         Row{2085, 0, 10, 0, 30, 1.992473890, 1.996549325},
                         Row{2085, 0, 80, 4000, 7, 7.716744107, 7.907188415}}) {
    INFO(row.latitude_deg << " deg, elevation " << row.elevation_deg);
    const TroposphereMapping mapping =
        niell_mapping(at(row.latitude_deg, row.height), row.elevation_deg * kDegree,
                      GpsTime::from_week_and_tow(row.week, row.tow));
    // A day's difference in the season: 1e-4 at 5 degrees.
    CHECK(mapping.hydrostatic == Approx(row.hydrostatic).epsilon(2e-5));
    CHECK(mapping.wet == Approx(row.wet).epsilon(1e-8));
  }
}

TEST_CASE("The mapping is one at zenith and does not need a time", "[troposphere]") {
  const TroposphereMapping zenith = niell_mapping(at(50, 300), std::numbers::pi / 2);
  CHECK(zenith.hydrostatic == Approx(1.0).margin(1e-12));
  CHECK(zenith.wet == Approx(1.0).margin(1e-12));
  const double without = niell_mapping(at(50, 300), 5 * kDegree).hydrostatic;
  const double with =
      niell_mapping(at(50, 300), 5 * kDegree, GpsTime::from_week_and_tow(2111, 0)).hydrostatic;
  CHECK(without == Approx(with).epsilon(0.01));
  CHECK(without != with);
}

TEST_CASE("Delays stay finite, positive and continuous at any height and elevation",
          "[troposphere]") {
  double previous = std::numeric_limits<double>::infinity();
  for (const double height : {-11e3, -500.0, -100.0, 0.0, 4000.0, 8848.0, 11e3, 2e4, 5e5, 6e6}) {
    const double zenith = saastamoinen_slant_delay_m(at(30, height), std::numbers::pi / 2);
    INFO(height);
    CHECK(zenith > 0.3);
    CHECK(zenith < 3.0);
    CHECK(zenith <= previous);
    previous = zenith;
    for (const double elevation : {-1.0, 0.0, 0.01, 0.5}) {
      const double slant = saastamoinen_slant_delay_m(at(30, height), elevation);
      CHECK(slant >= zenith);
      CHECK(slant < 120.0);
    }
  }
}

}  // namespace leonav
