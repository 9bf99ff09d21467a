#include "core/gnss/propagation/antenna_model.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "antenna_patterns.h"
#include "core/base/angle.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::receiver_pattern;
using test::satellite_pattern;

// Forward-right-down of an antenna that stands.
Vector3d direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), -std::sin(e)};
}

AntennaGrid azimuth_grid() {  // 3 zenith angles, azimuths 0, 90, ... 360
  AntennaGrid grid;
  grid.angle_step = 10.0 * kDegree;
  grid.angles = 3;
  grid.azimuths = 5;
  for (const float v : {0.0F, 1.0F, 2.0F, 0.0F, 3.0F, 6.0F, 0.0F, 5.0F, 10.0F, 0.0F, 7.0F, 14.0F,
                        0.0F, 1.0F, 2.0F}) {
    grid.values.push_back(v * 0.01F);
  }
  return grid;
}

}  // namespace

// RTKLIB 2.4.3 (pyrtklib) satantoff on the IGS's igs14.atx, for the ionosphere-free pair and with
// its own Sun, which is used here too. GPS: L1/L2, Galileo: E1/E5a.
TEST_CASE("A satellite's offset shifts the range as RTKLIB's does", "[antenna]") {
  struct Row {
    SatelliteId id;
    char band_2;
    Vector3d offset_1_mm, offset_2_mm, p_sat_e, rtklib_m;
  };
  const Vector3d p_sun(-100512420581, 96868202568, 60309717547);
  const Vector3d p_a(3582104.766, 532590.177, 5232755.098);
  for (const Row& row : {Row{{System::kGps, 5},
                             '2',
                             {-3.3, -0.3, 778.0},
                             {-3.3, -0.3, 778.0},
                             {15600e3, 7540e3, 20140e3},
                             {-0.454568, -0.223045, -0.590689}},
                         Row{{System::kGps, 18},
                             '2',
                             {3.8, -18.1, 1232.4},
                             {3.1, -16.2, 740.5},
                             {2000e3, -22000e3, 14500e3},
                             {-0.16949, 1.651974, -1.101702}},
                         Row{{System::kGalileo, 11},
                             '7',
                             {-169.37, 29.63, 811.77},
                             {0, 0, 0},
                             {24000e3, 9000e3, 14900e3},
                             {-1.350886, -0.83138, -1.234035}}}) {
    const Matrix3d C_es =
        satellite_axes(row.p_sat_e, Vector3d::Zero(), p_sun, AttitudeLaw::kYawSteering);
    const auto range = [&](char band, const Vector3d& offset_mm) {
      const AntennaPattern pattern = satellite_pattern(row.id, band, offset_mm);
      REQUIRE(is_sane(pattern));
      return satellite_antenna_range_m(pattern.offset_m, view(pattern.variation), row.p_sat_e, C_es,
                                       p_a);
    };
    const double f1 = frequency_hz(row.id.system, '1'),
                 f2 = frequency_hz(row.id.system, row.band_2);
    const double share = f1 * f1 / (f1 * f1 - f2 * f2);
    const double ours =
        share * range('1', row.offset_1_mm) - (share - 1.0) * range(row.band_2, row.offset_2_mm);
    const double theirs = (row.p_sat_e + row.rtklib_m - p_a).norm() - (row.p_sat_e - p_a).norm();
    CHECK(ours == Approx(theirs).margin(2e-6));
    CHECK(ours < -0.5);  // the phase centre is nearer to the Earth
  }
}

// RTKLIB's antmodel_s for G18 and antmodel for ASH701945E_M SCIS, whose grid ends at 80 degrees.
TEST_CASE("Variations agree with RTKLIB's", "[antenna]") {
  const AntennaPattern g18 = satellite_pattern(
      {System::kGps, 18}, '1', {0, 0, 0}, 1.0,
      {13.9, 12.8, 10.2, 5.8, 1.1, -4.5, -9.7, -12.8, -13.4, -11.8, -8.9, -4.5, 1.2, 7.2, 13.3});
  struct Nadir {
    double deg, range_m;
  };
  const double tail = 0.0133;
  for (const Nadir& row : {Nadir{0.0, 0.0139}, Nadir{3.3, 0.00439}, Nadir{9.75, -0.009625},
                           Nadir{13.9, 0.01269}, Nadir{16.0, tail}, Nadir{25.0, tail}}) {
    CHECK(variation_m(view(g18.variation), row.deg * kDegree, 0.0) ==
          Approx(row.range_m).margin(1e-8));
  }
  const AntennaPattern l1 =
      receiver_pattern(System::kGps, '1', {0.50, 0.04, 89.04},
                       {0.00, -0.44, -1.42, -2.77, -4.18, -5.99, -7.45, -8.79, -9.57, -9.90, -9.74,
                        -8.86, -7.67, -5.84, -3.30, -0.23, 3.69});
  const AntennaPattern l2 =
      receiver_pattern(System::kGps, '2', {-0.60, -0.02, 118.96},
                       {0.00, -0.43, -1.02, -1.80, -2.62, -3.42, -4.23, -5.01, -5.75, -6.23, -6.25,
                        -5.83, -5.08, -3.75, -2.13, -0.11, 2.56});
  REQUIRE(is_sane(l1));
  struct Row {
    double azimuth, elevation, l1, l2;
  };
  for (const Row& row :
       {Row{0, 90, -0.08904, -0.11896}, Row{30, 72.5, -0.0885302, -0.1155049},
        Row{135, 41, -0.067942, -0.0846003}, Row{250, 15.2, -0.0234968, -0.031597},
        Row{10, 10, -0.0122634, -0.0175119}, Row{300, 3, -0.0011851, -0.0033836}}) {
    const Vector3d u_r = direction(row.azimuth, row.elevation);
    CHECK(receiver_antenna_range_m(l1.offset_m, view(l1.variation), u_r) ==
          Approx(row.l1).margin(2e-7));
    CHECK(receiver_antenna_range_m(l2.offset_m, view(l2.variation), u_r) ==
          Approx(row.l2).margin(2e-7));
  }
}

TEST_CASE("A grid with azimuths is bilinear, periodic, and constant beyond its end", "[antenna]") {
  const AntennaGrid grid = azimuth_grid();
  const auto at = [&](double angle_deg, double azimuth_deg) {
    return variation_m(view(grid), angle_deg * kDegree, azimuth_deg * kDegree);
  };
  CHECK(at(10, 0) == Approx(0.01));
  CHECK(at(10, 360) == Approx(0.01));
  CHECK(at(10, 90) == Approx(0.03));
  CHECK(at(10, -90) == Approx(0.07));
  CHECK(at(5, 45) == Approx(0.25 * (0.0 + 0.01 + 0.0 + 0.03)));
  CHECK(at(15, 315) == Approx(0.25 * (0.07 + 0.14 + 0.01 + 0.02)));
  CHECK(at(20, 180) == Approx(0.10));
  CHECK(at(70, 180) == Approx(0.10));
  CHECK(at(-5, 180) == Approx(0.0));
  CHECK(at(10, 720 + 90) == Approx(0.03));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(at(nan, 0) == 0.0);
  CHECK(at(10, nan) == 0.0);
  // An antenna's own north counts: the satellite in the east of one turned to the east stands at 0.
  const AntennaGrid seen = grid;
  CHECK(receiver_antenna_range_m(Vector3d::Zero(), view(seen), direction(90, 80)) == Approx(0.03));
}

TEST_CASE("The satellite's azimuth runs from Y towards X", "[antenna]") {
  const AntennaGrid grid = azimuth_grid();
  const Vector3d p_sat(0, 0, 1e6);
  Matrix3d C_es;  // Z down, X along x, Y against y
  C_es << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const double across = 1e6 * std::tan(10.0 * kDegree);
  const auto from = [&](double x, double y) {
    return satellite_antenna_range_m(Vector3d::Zero(), view(grid), p_sat, C_es,
                                     Vector3d(across * x, across * y, 0));
  };
  CHECK(from(0, -1) == Approx(0.01));  // along body Y
  CHECK(from(1, 0) == Approx(0.03));   // along body X
  CHECK(from(0, 1) == Approx(0.05));
}

TEST_CASE("A pattern no antenna has is not sane", "[antenna]") {
  const AntennaPattern good =
      receiver_pattern(System::kGps, '1', {0.5, 0.04, 89.0}, {0.0, -0.44, -1.42});
  REQUIRE(is_sane(good));
  const auto bad = [&](auto change) {
    AntennaPattern pattern = good;
    change(pattern);
    return !is_sane(pattern);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const float nan_f = std::numeric_limits<float>::quiet_NaN();
  CHECK(bad([&](auto& p) { p.offset_m.y() = nan; }));
  CHECK(bad([&](auto& p) { p.offset_m.z() = 11.0; }));
  CHECK(bad([&](auto& p) { p.band = '4'; }));
  CHECK(bad([&](auto& p) { p.satellite.number = 3; }));
  CHECK(bad([&](auto& p) { p.satellite.system = static_cast<System>(9); }));
  CHECK(bad([&](auto& p) { p.is_receiver = false; }));
  CHECK(bad([&](auto& p) { p.variation.values[1] = nan_f; }));
  CHECK(bad([&](auto& p) { p.variation.values[1] = 1.5F; }));
  CHECK(bad([&](auto& p) { p.variation.angles = 2; }));
  CHECK(bad([&](auto& p) { p.variation.angles = -3; }));
  CHECK(bad([&](auto& p) { p.variation.azimuths = 2; }));
  CHECK(bad([&](auto& p) { p.variation.azimuths = 2147483647; }));
  CHECK(bad([&](auto& p) { p.variation.angle_step = 0.0; }));
  CHECK(bad([&](auto& p) { p.variation.angle_step = nan; }));
  CHECK(bad([&](auto& p) { p.variation.angle_step = 2.0; }));
  CHECK(bad([&](auto& p) {
    p.valid_from = GpsTime::from_week_and_tow(2000, 0);
    p.valid_until = GpsTime::from_week_and_tow(1999, 0);
  }));
}

}  // namespace leonav
