#include "core/gnss/propagation/ionosphere.h"

#include "core/base/angle.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"

namespace leonav {
namespace {

const double kL1 = frequency_hz(System::kGps, '1');

struct Row {
  KlobucharModel model;
  int week;
  double tow;
  double latitude_deg, longitude_deg, azimuth_deg, elevation_deg;
  double delay_m;
};

double delay_of(const Row& row, double frequency = kL1) {
  return klobuchar_delay_m(row.model,
                           {row.latitude_deg * kDegree, row.longitude_deg * kDegree, 0.0},
                           {row.elevation_deg * kDegree, row.azimuth_deg * kDegree},
                           GpsTime::from_week_and_tow(row.week, row.tow), frequency);
}

constexpr KlobucharModel kExample = {
    {3.82e-8, 1.49e-8, -1.79e-7, 0.0}, {1.43e5, 0.0, -3.28e5, 1.13e5}, true};
constexpr KlobucharModel kQuietSun = {{4.6566e-09, 1.4901e-08, -5.9605e-08, -1.1921e-07},
                                      {81920.0, 98304.0, -65536.0, -524290.0},
                                      true};

}  // namespace

// RTKLIB's ionmodel; the first line's inputs are the widely used worked example whose answer is
// given as 23.784 m.
TEST_CASE("Klobuchar delays agree with RTKLIB's", "[ionosphere]") {
  for (const Row& row : {Row{kExample, 1068, 593100, 40, -100, 210, 20, 23.784147585},
                         Row{kExample, 2111, 0, 55, 8, 10, 60, 1.681395106},
                         Row{kExample, 2111, 50000, -35, 149, 300, 15, 3.636241793},
                         Row{kQuietSun, 2111, 388800, 55.5, 8.4, 135, 33.3, 2.757304763},
                         Row{default_klobuchar(), 2300, 200000, 5, -170, 0.5, 89, 2.574297426}}) {
    INFO(row.latitude_deg << ' ' << row.longitude_deg);
    CHECK(delay_of(row) == Approx(row.delay_m).margin(1e-6));
  }
}

TEST_CASE("The ionosphere's delay goes with the inverse square of frequency", "[ionosphere]") {
  const Row row{kExample, 1068, 593100, 40, -100, 210, 20, 0.0};
  const double ratio = 77.0 / 60.0;
  CHECK(delay_of(row, frequency_hz(System::kGps, '2')) ==
        Approx(delay_of(row) * ratio * ratio).epsilon(1e-12));
}

TEST_CASE("Without coefficients the default set stands in", "[ionosphere]") {
  Row row{KlobucharModel{}, 1068, 593100, 40, -100, 210, 20, 0.0};
  const double without = delay_of(row);
  row.model = default_klobuchar();
  CHECK(without == delay_of(row));
  CHECK(without > 1.5);
}

TEST_CASE("Below the horizon, on no frequency or with NaN there is no delay", "[ionosphere]") {
  Row row{kExample, 1068, 593100, 40, -100, 210, -1, 0.0};
  CHECK(delay_of(row) == 0.0);
  row.elevation_deg = std::numeric_limits<double>::quiet_NaN();
  CHECK(delay_of(row) == 0.0);
  row.elevation_deg = 20;
  CHECK(delay_of(row, 0.0) == 0.0);
}

}  // namespace leonav
