// The whole of a recorded navigation file against RTKLIB, where a table of RTKLIB's is at hand.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <tuple>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/rinex/navigation_reader.h"
#include "support/catch.h"

namespace leonav {

// Compares with a table made by test/oracle/broadcast_orbits.py from any navigation file.
TEST_CASE("A whole navigation file agrees with RTKLIB", "[oracle]") {
  const char* nav_path = std::getenv("LEONAV_ORBIT_ORACLE_NAV");
  const char* table_path = std::getenv("LEONAV_ORBIT_ORACLE");
  if (nav_path == nullptr || table_path == nullptr) {
    std::cout
        << "SKIPPED (optional): LEONAV_ORBIT_ORACLE and LEONAV_ORBIT_ORACLE_NAV name no files "
           "(test/oracle/broadcast_orbits.py makes them)\n";
    return;
  }
  using Key = std::tuple<std::string, std::string, int, GpsTime>;
  std::map<Key, Ephemeris> ephemerides;
  const char* const names[] = {"kGpsLnav", "kGalileoInav", "kGalileoFnav", "kBeidouD1",
                               "kBeidouD2"};
  for (const Ephemeris& e : read_navigation(nav_path).ephemerides) {
    ephemerides[{to_string(e.satellite), names[static_cast<int>(e.message)], e.issue, e.toe}] = e;
  }
  std::ifstream table(table_path);
  std::string satellite, message;
  int issue = 0, week = 0, compared = 0, missing = 0;
  double tow = 0.0, offset = 0.0, clock = 0.0;
  Eigen::Vector3d p;
  std::map<std::string, std::pair<double, double>> worst;
  while (table >> satellite >> message >> issue >> week >> tow >> offset >> p.x() >> p.y() >>
         p.z() >> clock) {
    const auto found =
        ephemerides.find({satellite, message, issue, GpsTime::from_week_and_tow(week, tow)});
    if (found == ephemerides.end()) {
      if (missing++ < 3) std::cout << satellite << ' ' << message << ' ' << tow << " missing\n";
      continue;
    }
    const Ephemeris& e = found->second;
    REQUIRE(is_sane(e));
    const SatelliteState state = broadcast_state(e, e.toe.plus_seconds(offset));
    auto& [orbit, time] = worst[message + (is_beidou_geostationary(e.satellite) ? " GEO" : "")];
    orbit = std::max(orbit, (state.p_e - p).norm());
    time = std::max(time, std::abs(state.clock_s - clock));
    INFO(satellite << ' ' << message << ' ' << tow << ' ' << offset);
    CHECK((state.p_e - p).norm() < 0.01);
    CHECK(std::abs(state.clock_s - clock) < 1e-10);
    ++compared;
  }
  CHECK(compared > 0);
  CHECK(missing == 0);
  std::cout << compared << " states compared, " << missing << " without our ephemeris\n";
  for (const auto& [kind, w] : worst) {
    std::cout << kind << ": " << w.first << " m, " << w.second * 1e9 << " ns\n";
  }
}

}  // namespace leonav
