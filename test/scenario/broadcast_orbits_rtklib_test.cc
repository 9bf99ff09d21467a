// Every satellite position and clock that RTKLIB computes for a recording, from the trace that
// rnx2rtkp writes, against leonav's from the same elements.
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "support/catch.h"
#include "support/recorded/dataset.h"
#include "support/recorded/rtklib_ephemerides.h"
#include "support/recorded/rtklib_single.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct TracedState {
  GpsTime time;  // of transmission, to the microsecond
  SatelliteId satellite;
  Eigen::Vector3d p_e;
  double clock_s = 0.0;
};

// RTKLIB's satellite numbers as Debian builds it: 32 GPS, 27 GLONASS, 36 Galileo, 10 QZSS, BeiDou.
std::optional<SatelliteId> satellite_of(int number) {
  const auto within = [number](int first, int count) {
    return number >= first && number < first + count;
  };
  const auto id = [number](System system, int first) {
    return SatelliteId{system, static_cast<std::uint16_t>(number - first + 1)};
  };
  if (within(1, 32)) return id(System::kGps, 1);
  if (within(60, 36)) return id(System::kGalileo, 60);
  if (within(106, 63)) return id(System::kBeidou, 106);
  return std::nullopt;
}

// "4 2020/06/24 23:59:59.914260 sat= 2 rs= X Y Z dts= NANOSECONDS var=..."
std::optional<TracedState> parse_state(std::string line) {
  if (line.find(" rs=") == std::string::npos || line.find(" dts=") == std::string::npos) return {};
  for (char& c : line) {
    if (c == '/' || c == ':' || c == '=') c = ' ';
  }
  std::istringstream fields(line);
  int level = 0, year = 0, month = 0, day = 0, hour = 0, minute = 0, number = 0;
  double second = 0.0, clock_ns = 0.0;
  std::string word;
  TracedState state;
  fields >> level >> year >> month >> day >> hour >> minute >> second >> word >> number >> word;
  fields >> state.p_e.x() >> state.p_e.y() >> state.p_e.z() >> word >> clock_ns;
  const auto id = satellite_of(number);
  if (!fields || !id) return {};
  state.time = from_calendar({year, month, day, hour, minute, second});
  state.satellite = *id;
  state.clock_s = 1.0e-9 * clock_ns;
  return state;
}

}  // namespace

TEST_CASE("station: every broadcast position and clock agrees with RTKLIB's") {
  constexpr const char* kObservations = "station/ESBC00DNK_2020177_6H_30S.obs";
  constexpr const char* kNavigation = "station/ESBC00DNK_2020177.nav";
  if (!have_shared_data(kNavigation) || !have_rtklib()) return;
  const TemporaryFile place("orbits.conf", "");
  const std::string solution = place.beside("orbits.pos");
  const std::string command = "rnx2rtkp -x 4 -p 0 -sys G,E,C -t -o '" + solution + "' '" +
                              shared_data(kObservations) + "' '" + shared_data(kNavigation) +
                              "' >/dev/null 2>&1";
  REQUIRE(std::system(command.c_str()) == 0);

  const Dataset data = read_station(false);
  RtklibFeed feed(data, EphemerisConfig{});
  struct Worst {
    long compared = 0;
    double position_m = 0.0, clock_s = 0.0;
  };
  std::map<System, Worst> worst;
  std::ifstream trace(solution + ".trace");
  for (std::string line; std::getline(trace, line);) {
    const auto theirs = parse_state(line);
    if (!theirs) continue;
    // The epoch, by which both choose the elements: 30 s apart, and the signal on its way
    // 0.06-0.15.
    const GpsTime epoch = GpsTime::from_week_and_tow(
        theirs->time.week(), 30.0 * std::round((theirs->time.tow_s() + 0.1) / 30.0));
    const bool between = std::abs(std::remainder(epoch.tow_s() - 3600.0, 7200.0)) < 0.5;
    if (between && theirs->satellite.system == System::kGps) continue;  // either may be taken
    const Ephemeris* ephemeris = feed.at(epoch).ephemeris_at(theirs->satellite, epoch);
    if (ephemeris == nullptr) continue;
    const SatelliteState ours = broadcast_state(*ephemeris, theirs->time);
    Worst& w = worst[theirs->satellite.system];
    ++w.compared;
    w.position_m = std::max(w.position_m, (ours.p_e - theirs->p_e).norm());
    w.clock_s = std::max(w.clock_s, std::abs(ours.clock_s - theirs->clock_s));
  }
  CHECK(worst.size() == 3);
  for (const auto& [system, w] : worst) {
    std::cout << "station, " << to_string(system) << ": " << w.compared
              << " broadcast states, worst " << w.position_m << " m, " << w.clock_s << " s\n";
    CHECK(w.compared > 5000);
    CHECK(w.position_m < 4.0e-3);  // half a microsecond of the trace's time and half millimetres
    CHECK(w.clock_s < 2.0e-12);
  }
}
