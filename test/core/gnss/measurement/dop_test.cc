#include "core/gnss/measurement/dop.h"

#include <Eigen/Core>
#include <memory>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"

using namespace leonav;

namespace {

struct Direction {
  System system;
  double azimuth_deg, elevation_deg;
};

Eigen::Vector3d unit_ned(const Direction& d) {
  const double a = d.azimuth_deg * kDegree, e = d.elevation_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), -std::sin(e)};
}

const Geodetic kPlace{0.8, 0.2, 100.0};

std::unique_ptr<MeasurementEpoch> epoch_of(const std::vector<Direction>& sky) {
  auto epoch = std::make_unique<MeasurementEpoch>();
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(kPlace).transpose();
  for (const Direction& direction : sky) {
    SatelliteInView view;
    view.satellite = {direction.system, static_cast<std::uint16_t>(epoch->satellites.size() + 1)};
    view.p_e = to_ecef(kPlace) + 2.2e7 * (C_en * unit_ned(direction));
    Measurement code;
    code.satellite_index = static_cast<std::uint16_t>(epoch->satellites.size());
    code.sigma = 1.0 + static_cast<double>(epoch->satellites.size());  // must not matter
    epoch->satellites.push_back(view);
    epoch->measurements.push_back(code);
  }
  return epoch;
}

// Kaplan and Hegarty, Understanding GPS, 7.3: the inverse of H^T H with rows (-unit vector, 1), in
// local axes, every clock a column of its own.
Dop direct(const std::vector<Direction>& sky, int systems) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(sky.size()), 3 + systems);
  for (Eigen::Index i = 0; i < h.rows(); ++i) {
    const Direction& direction = sky[static_cast<std::size_t>(i)];
    h.block<1, 3>(i, 0) = -unit_ned(direction).transpose();
    h(i, 3 + static_cast<int>(index_of(direction.system))) = 1.0;
  }
  const Eigen::MatrixXd q = dense::inverse(h.transpose() * h);
  return {std::sqrt(q(0, 0) + q(1, 1) + q(2, 2)), std::sqrt(q(0, 0) + q(1, 1)), std::sqrt(q(2, 2)),
          std::sqrt(q.trace())};
}

const std::vector<Direction> kSky = {
    {System::kGps, 10, 70},      {System::kGps, 80, 35},     {System::kGps, 200, 20},
    {System::kGps, 300, 50},     {System::kGalileo, 40, 15}, {System::kGalileo, 150, 60},
    {System::kGalileo, 260, 30},
};

}  // namespace

TEST_CASE("DOP is that of the direct formula, for one clock and for two") {
  const std::vector<Direction> gps(kSky.begin(), kSky.begin() + 4);
  for (const auto& [sky, systems] : {std::pair(gps, 1), std::pair(kSky, 2)}) {
    const Dop expected = direct(sky, systems);
    const Dop dop = dilution_of_precision(*epoch_of(sky), to_ecef(kPlace));
    CAPTURE(systems, expected.pdop);
    CHECK(dop.pdop == Approx(expected.pdop).epsilon(1e-9));
    CHECK(dop.hdop == Approx(expected.hdop).epsilon(1e-9));
    CHECK(dop.vdop == Approx(expected.vdop).epsilon(1e-9));
    CHECK(dop.gdop == Approx(expected.gdop).epsilon(1e-9));
  }
}

// Tetrahedron: one satellite overhead, three at the horizon 120 degrees apart. By hand: HDOP =
// sqrt(4/3), VDOP = sqrt(4/3), TDOP = sqrt(1/3), GDOP = sqrt(3).
TEST_CASE("DOP of the textbook's best geometry of four") {
  const Dop dop = dilution_of_precision(*epoch_of({{System::kGps, 0, 90},
                                                   {System::kGps, 0, 0},
                                                   {System::kGps, 120, 0},
                                                   {System::kGps, 240, 0}}),
                                        to_ecef(kPlace));
  CHECK(dop.hdop == Approx(std::sqrt(4.0 / 3.0)).epsilon(1e-9));
  CHECK(dop.vdop == Approx(std::sqrt(4.0 / 3.0)).epsilon(1e-9));
  CHECK(dop.gdop == Approx(std::sqrt(3.0)).epsilon(1e-9));
}

TEST_CASE("DOP counts satellites in use, once each") {
  auto epoch = epoch_of(kSky);
  epoch->measurements.push_back(epoch->measurements.front());  // a second signal
  Measurement doppler = epoch->measurements[1];
  doppler.observable = Observable::kDoppler;
  epoch->measurements.push_back(doppler);
  CHECK(dilution_of_precision(*epoch, to_ecef(kPlace)).pdop ==
        Approx(direct(kSky, 2).pdop).epsilon(1e-9));
  for (std::size_t i = 4; i < 7; ++i) epoch->measurements[i].reason = Reason::kOutlier;
  const std::vector<Direction> gps(kSky.begin(), kSky.begin() + 4);
  CHECK(dilution_of_precision(*epoch, to_ecef(kPlace)).pdop ==
        Approx(direct(gps, 1).pdop).epsilon(1e-9));
}

TEST_CASE("no DOP where the geometry determines no position") {
  for (const auto& sky : std::vector<std::vector<Direction>>{
           {},
           {kSky.begin(), kSky.begin() + 3},
           // All on one cone around the zenith: the height cannot be told from the clock.
           {{System::kGps, 0, 30},
            {System::kGps, 90, 30},
            {System::kGps, 180, 30},
            {System::kGps, 270, 30}}}) {
    const Dop dop = dilution_of_precision(*epoch_of(sky), to_ecef(kPlace));
    CHECK(std::isnan(dop.pdop));
    CHECK(std::isnan(dop.hdop));
    CHECK(std::isnan(dop.vdop));
    CHECK(std::isnan(dop.gdop));
  }
}
