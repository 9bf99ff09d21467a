// Streets, decks, leaves and tunnels: geometry against coordinates, edges against the integrals.
#include "tools/sim/places/surroundings.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "core/base/angle.h"
#include "support/catch.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

constexpr SatelliteId kAny{System::kGps, 7};

struct Scene {
  explicit Scene(const std::string& places, double standing_s = 30.0)
      : scenario(load_scenario_text(
            "duration_s: 200\nroute: {standing_s: " + std::to_string(standing_s) +
                ", waypoints: [{}, {north_m: 2000}]}\nplaces: " + places,
            "test.yaml")),
        motion(drive(scenario)),
        surroundings(scenario, motion) {}

  Reception look(double t, double azimuth_deg, double elevation_deg) const {
    return surroundings.reception(surroundings.at(t), kAny,
                                  {elevation_deg * kDegree, azimuth_deg * kDegree}, {});
  }

  Scenario scenario;
  SplineMotion motion;
  Surroundings surroundings;
};

// Both walls 20 m high without a hole; the vehicle drives north, 2.5 m right of the middle.
const std::string kEvenStreet =
    "[{from_s: 0, place: urban_canyon, street_width_m: 30, house_height_m: 20,"
    " house_height_sigma_m: 0, gap_share: 0, crossing_width_m: 0, horizon_deg: 0,"
    " reflection_db: 12}]";

// The field behind a half plane, by its definition: ITU-R P.526, eq. 7 and 30.
double knife_edge_by_integral(double v) {
  std::complex<double> sum = 0.0;
  constexpr int kSteps = 200'000;
  const double h = v / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double s = (i + 0.5) * h;
    sum += h * std::polar(1.0, 0.5 * std::numbers::pi * s * s);
  }
  const double c = sum.real(), s = sum.imag();
  return -20.0 * std::log10(0.5 * std::hypot(1.0 - c - s, c - s));
}

}  // namespace

TEST_CASE("Loss at an edge is that of the Fresnel integrals", "[sim][places]") {
  // v = -clearance * sqrt(2 / (wavelength * distance)); the fit is good to some tenths.
  for (const double v : {-0.7, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0}) {
    INFO("v = " << v);
    const double clearance = -v * std::sqrt(0.2 * 30.0 / 2.0);
    REQUIRE(std::abs(knife_edge_loss_db(clearance, 30.0, 0.2) - knife_edge_by_integral(v)) < 0.5);
  }
  REQUIRE(knife_edge_loss_db(100.0, 30.0, 0.2) == 0.0);
}

TEST_CASE("A street hides what stands behind its houses", "[sim][places]") {
  const Scene street(kEvenStreet);
  // To the right the wall is 12.5 m away, its roof 18.4 m up: 55.8 degrees; to the left 17.5 m:
  // 46.4 degrees.
  REQUIRE(street.look(5.0, 90.0, 65.0).loss_db == 0.0);
  REQUIRE(street.look(5.0, 90.0, 65.0).line_of_sight);
  REQUIRE(street.look(5.0, 90.0, 55.8).loss_db == Approx(6.0).margin(0.7));
  REQUIRE(street.look(5.0, 90.0, 45.0).loss_db > 10.0);
  REQUIRE(street.look(5.0, 270.0, 50.0).loss_db < 1.0);
  REQUIRE(street.look(5.0, 270.0, 40.0).loss_db > 10.0);
  // Along the street it is free.
  REQUIRE(street.look(5.0, 0.5, 10.0).loss_db == 0.0);
  REQUIRE(street.look(5.0, 181.0, 10.0).loss_db == 0.0);
}

TEST_CASE("A reflection's way is that to the mirrored satellite", "[sim][places]") {
  const Scene street(kEvenStreet);
  // East of the vehicle at 40 degrees: hidden by the right wall, reflected by the left one.
  int seen = 0;
  for (const double azimuth : {50.0, 70.0, 90.0, 120.0, 250.0, 290.0}) {
    for (const double elevation : {35.0, 40.0, 44.0}) {
      const Reception r = street.look(5.0, azimuth, elevation);
      if (r.line_of_sight) continue;
      ++seen;
      const double wall_east_m = azimuth < 180.0 ? -17.5 : 12.5;
      const Eigen::Vector3d u(std::cos(elevation * kDegree) * std::cos(azimuth * kDegree),
                              std::cos(elevation * kDegree) * std::sin(azimuth * kDegree),
                              std::sin(elevation * kDegree));
      const Eigen::Vector3d satellite = 2e10 * u;
      Eigen::Vector3d image = satellite;
      image.y() = 2.0 * wall_east_m - satellite.y();
      REQUIRE(r.extra_m == Approx(image.norm() - satellite.norm()).margin(1e-3));
      REQUIRE(r.route != 0);
      REQUIRE(r.loss_db >= 3.0);
    }
  }
  REQUIRE(seen >= 4);
}

TEST_CASE("A reflection passes over the houses ahead, where its ray comes from", "[sim][places]") {
  // At 45 degrees to the right and 10 degrees up: hidden by the house 12.5 m ahead, thrown back by
  // the wall 17.5 m ahead, to which the ray comes over the right side at 17.5 + 30 m = 47.5 m: too
  // low for the houses there (13 m of 20), so that only a crossing lets it through.
  const auto look_with = [](const std::string& crossings) {
    std::string places = kEvenStreet;
    places.replace(places.find("crossing_width_m: 0"), 19, crossings);
    return Scene(places).look(5.0, 45.0, 10.0);
  };
  REQUIRE_FALSE(look_with("crossing_every_m: 45, crossing_width_m: 5").line_of_sight);
  REQUIRE(look_with("crossing_width_m: 0").line_of_sight);
  // A crossing 12.5 m behind is of no help.
  REQUIRE(look_with("crossing_every_m: 14, crossing_width_m: 2").line_of_sight);
}

TEST_CASE("The rate of a reflection's way is its derivative", "[sim][places]") {
  const Scene street(kEvenStreet);
  const PlaceNow now = street.surroundings.at(5.0);
  const LookAngles rates{0.004, 0.003};
  const auto at = [&](double dt) {
    return street.surroundings.reception(
        now, kAny, {40.0 * kDegree + rates.elevation * dt, 1.2 + rates.azimuth * dt}, rates);
  };
  REQUIRE_FALSE(at(0.0).line_of_sight);
  const double slope = (at(0.1).extra_m - at(-0.1).extra_m) / 0.2;
  REQUIRE(at(0.0).extra_m_s == Approx(slope).epsilon(1e-4));
  REQUIRE(std::abs(slope) > 0.02);
}

TEST_CASE("Under a viaduct the sky is open to the sides", "[sim][places]") {
  const Scene deck("[{from_s: 0, place: viaduct}]");
  REQUIRE(deck.look(5.0, 90.0, 80.0).loss_db > 15.0);
  REQUIRE(deck.look(5.0, 0.0, 30.0).loss_db > 15.0);
  // The deck's edge is 6.5 m to the right and 5.4 m up.
  REQUIRE(deck.look(5.0, 90.0, 20.0).loss_db < 1.0);
  REQUIRE(deck.look(5.0, 270.0, 15.0).loss_db < 1.0);
}

TEST_CASE("Nothing gets into a tunnel, and all comes back after it", "[sim][places]") {
  const Scene scene("[{from_s: 50, place: tunnel}, {from_s: 60, place: open_sky}]");
  REQUIRE(scene.look(49.9, 90.0, 80.0).possible);
  REQUIRE_FALSE(scene.look(50.0, 90.0, 80.0).possible);
  REQUIRE_FALSE(scene.look(59.9, 90.0, 80.0).possible);
  REQUIRE(scene.look(60.0, 90.0, 80.0).loss_db == 0.0);
}

TEST_CASE("Leaves cost more the lower the satellite, and change along the way", "[sim][places]") {
  const Scene woods("[{from_s: 0, place: woods}]");
  double high = 0.0, low = 0.0, first = woods.look(60.0, 0.0, 70.0).loss_db;
  bool changed = false;
  for (double t = 60.0; t < 150.0; t += 1.0) {
    high += woods.look(t, 90.0, 70.0).loss_db;
    low += woods.look(t, 90.0, 20.0).loss_db;
    changed = changed || std::abs(woods.look(t, 90.0, 70.0).loss_db - first) > 2.0;
  }
  REQUIRE(high > 90.0 * 3.0);
  REQUIRE(low > 2.0 * high);
  REQUIRE(changed);
}

TEST_CASE("Segments begin where the way says", "[sim][places]") {
  const Scene scene("[{from_m: 100, place: tunnel}, {from_m: 300, place: open_sky}]");
  const Odometer odometer(scene.motion);
  const double in = odometer.when_s(100.0), out = odometer.when_s(300.0);
  REQUIRE(odometer.travelled_m(in) == Approx(100.0).margin(3.0));
  REQUIRE(scene.look(in - 0.5, 0.0, 80.0).possible);
  REQUIRE_FALSE(scene.look(in + 0.5, 0.0, 80.0).possible);
  REQUIRE(scene.look(out + 0.5, 0.0, 80.0).possible);
  // 2 km straight on, and stays there: it has gone 2 km at the end.
  REQUIRE(odometer.travelled_m(1e9) < 2000.5);
}

TEST_CASE("Places that make no sense are refused", "[sim][places]") {
  REQUIRE_THROWS_WITH(Scene("[{from_s: 50, place: tunnel}, {from_s: 10, place: woods}]"),
                      Catch::Contains("places[1].from_s: begins before the segment ahead") &&
                          Catch::Contains(".yaml:") && Catch::Contains("in order"));
  REQUIRE_THROWS_WITH(Scene("[{place: tunnel}]"), Catch::Contains("from_s or from_m"));
  REQUIRE_THROWS_WITH(Scene("[{from_s: 1, from_m: 1, place: tunnel}]"),
                      Catch::Contains("not both"));
  REQUIRE_THROWS_WITH(Scene("[{from_s: 1, place: tunel}]"), Catch::Contains("tunnel"));
  REQUIRE_THROWS_WITH(Scene("citty"), Catch::Contains("dense_city"));
}
