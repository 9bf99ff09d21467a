#include "tools/sim/scenario/nominal_constellations.h"

#include <cmath>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"
#include "tools/sim/sky/true_sky.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

TrueSky nominal_sky() {
  return build_sky(load_scenario_text("duration_s: 7200\n", "scenario.yaml"));
}

}  // namespace

TEST_CASE("Nominal constellations have their satellites, each with a number of its own") {
  std::array<int, kSystemCount> count{};
  SatelliteId last{};
  for (const TrueSatellite& s : nominal_sky().satellites) {
    CHECK(is_valid(s.id));
    CHECK(last < s.id);
    last = s.id;
    ++count[index_of(s.id.system)];
  }
  CHECK(count == std::array<int, kSystemCount>{31, 24, 45, 160});
}

TEST_CASE("BeiDou satellites with geostationary numbers stand still, and no others do") {
  for (const TrueSatellite& s : nominal_sky().satellites) {
    if (s.id.system != System::kBeidou) continue;
    const Geodetic before = to_geodetic(to_earth(s.orbit.at(0.0).p_i, 0.0));
    const Geodetic after = to_geodetic(to_earth(s.orbit.at(7200.0).p_i, 7200.0));
    const double moved = std::hypot(after.latitude - before.latitude,
                                    std::remainder(after.longitude - before.longitude, 6.28318));
    INFO(to_string(s.id));
    CHECK((moved < 0.1 * kDegree) == is_beidou_geostationary(s.id));
  }
}

TEST_CASE("No two satellites of a system come near each other") {
  const TrueSky sky = nominal_sky();
  for (double t = 0.0; t <= 7200.0; t += 600.0) {
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
      for (std::size_t j = i + 1; j < sky.satellites.size(); ++j) {
        const TrueSatellite &a = sky.satellites[i], &b = sky.satellites[j];
        if (a.id.system != b.id.system) continue;
        INFO(to_string(a.id) << " " << to_string(b.id) << " at " << t);
        // Low satellites of two shells cross each other's way at one height.
        const double apart = a.id.system == System::kLeo ? 1e3 : 20e3;
        REQUIRE((a.orbit.at(t).p_i - b.orbit.at(t).p_i).norm() > apart);
      }
    }
  }
}

TEST_CASE("Of more satellites than there are numbers those that rise have one") {
  const std::string shells =
      "shells: [{semi_major_axis_km: 7348, planes: 20, per_plane: 32, inclination_deg: 60, "
      "node_span_deg: 360}]";
  CHECK_THROWS_WITH(load_scenario_text("satellites: {leo: {" + shells + "}}\n", "scenario.yaml"),
                    Catch::Contains("number 399") && Catch::Contains("only_risen"));
  // Who is up at the middle.
  const auto up = [](const std::string& keys) {
    const Scenario scenario = load_scenario_text("duration_s: 600\n" + keys, "scenario.yaml");
    const Eigen::Vector3d p_e = to_ecef(scenario.route.origin);
    std::vector<Eigen::Vector3d> places;
    for (const TrueSatellite& s : build_sky(scenario).satellites) {
      const Eigen::Vector3d p_s_e = to_earth(s.orbit.at(300.0).p_i, 300.0);
      if (s.id.system == System::kLeo && look_angles(p_s_e, p_e).elevation > 0.0)
        places.push_back(p_s_e);
    }
    return places;
  };
  CHECK(up("satellites: {leo: {only_risen: true, " + shells + "}}\n").size() > 30);
  // Of the nominal ones nobody who is up is missing.
  CHECK(up("") == up("satellites: {leo: {only_risen: true}}\n"));
}

TEST_CASE("Numbers that are taken or too high are errors") {
  const auto load = [](const std::string& keys) {
    load_scenario_text("satellites: {galileo: {" + keys + "}}\n", "scenario.yaml");
  };
  CHECK_THROWS_WITH(load("first_number: 40"), Catch::Contains("number 50"));
  CHECK_THROWS_WITH(load("shells: [{semi_major_axis_km: 29600, planes: 2, per_plane: 4}, "
                         "{semi_major_axis_km: 29600, first_number: 3}]"),
                    Catch::Contains("number 3") && Catch::Contains("twice"));
}

TEST_CASE("Low satellites send the signals that the scenario gives, on its carriers") {
  const auto load = [](const std::string& keys) {
    return load_scenario_text("satellites: {leo: {" + keys + "}}\n", "s.yaml");
  };
  const Scenario usual = load("enabled: true");
  CHECK(usual.bands() == BandPlan());
  CHECK(usual.constellations[index_of(System::kLeo)].signals[1] == SignalCode{'2', 'W'});
  const Scenario other = load("bands_mhz: {9: 2492.028, 3: 5020.5}, signals: [9S, 3C]");
  CHECK(other.bands().frequency_hz(System::kLeo, '3') == 5020.5e6);
  CHECK(other.constellations[index_of(System::kLeo)].signals[0] == SignalCode{'9', 'S'});
  CHECK_THROWS_WITH(load("signals: [9S, 2W]"),
                    Catch::Contains("s.yaml:1: ") && Catch::Contains("bands_mhz.9"));
  CHECK_THROWS_WITH(load("signals: [1C]"), Catch::Contains("two different"));
  CHECK_THROWS_WITH(load("signals: [1C, 1C]"), Catch::Contains("two different"));
  CHECK_THROWS_WITH(load("signals: [1C, S9]"), Catch::Contains("no RINEX code"));
  CHECK_THROWS_WITH(load_scenario_text("satellites: {gps: {signals: [1C, 5Q]}}\n", "s.yaml"),
                    Catch::Contains("unknown key"));
}

TEST_CASE("Orbits through the Earth are refused, planes without a span go all round") {
  const auto leo = [](const std::string& shell) {
    return load_scenario_text("satellites: {leo: {shells: [{" + shell + "}]}}", "s.yaml")
        .constellations[index_of(System::kLeo)];
  };
  CHECK_THROWS_WITH(leo("semi_major_axis_km: 6600, eccentricity: 0.5"),
                    Catch::Contains("s.yaml:1: ") && Catch::Contains("6500 km"));
  CHECK_NOTHROW(leo("semi_major_axis_km: 26560, eccentricity: 0.5"));
  CHECK_NOTHROW(leo("semi_major_axis_km: 6600, eccentricity: 0.01"));
  constexpr double kTurn = 2.0 * 3.14159265358979;
  CHECK(leo("planes: 6, semi_major_axis_km: 7348").shells[0].node_span == Approx(kTurn));
  CHECK(leo("planes: 6, semi_major_axis_km: 7348, node_span_deg: 180").shells[0].node_span ==
        Approx(0.5 * kTurn));
  CHECK(leo("planes: 6, semi_major_axis_km: 7348, node_span_deg: 0").shells[0].node_span == 0.0);
}
