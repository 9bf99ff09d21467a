#include "tools/sim/run/sky_statistics.h"

#include <sstream>

#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;

TEST_CASE("More systems see more satellites and stand better; none is tracked that is not up") {
  const Scenario scenario = load_scenario_text("duration_s: 600\n", "scenario.yaml");
  const SkyStatistics sky = sky_statistics(scenario, 15.0 * 3.14159265358979 / 180.0, 60.0);
  const auto series = [&](const std::string& name) {
    for (std::size_t i = 0; i < sky.combinations.size(); ++i) {
      if (sky.combinations[i].name == name) return sky.in_the_sky[i];
    }
    throw std::runtime_error(name);
  };
  const SkySeries gps = series("gps"), leo = series("leo"), both = series("gps+leo");
  REQUIRE(gps.satellites.size() == 9);
  REQUIRE(gps.pdop.size() == 9);
  REQUIRE(both.pdop.size() == 9);
  for (std::size_t i = 0; i < gps.satellites.size(); ++i) {
    CHECK(both.satellites[i] == gps.satellites[i] + leo.satellites[i]);
    CHECK(both.pdop[i] < gps.pdop[i]);
    CHECK(gps.satellites[i] >= 4.0);
  }
  for (std::size_t c = 0; c < sky.combinations.size(); ++c) {
    for (std::size_t i = 0; i < sky.tracked[c].satellites.size(); ++i) {
      CHECK(sky.tracked[c].satellites[i] <= sky.in_the_sky[c].satellites[i]);
    }
  }
  std::ostringstream text;
  print(sky, text);
  CHECK(text.str().find("13.4 / 1.9") != std::string::npos);
}
