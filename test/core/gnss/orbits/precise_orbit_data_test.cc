// Precise orbits of a recorded day: nodes against their neighbours, and against broadcast.
#include <algorithm>
#include <iostream>
#include <map>
#include <vector>

#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/orbits/precise_orbit.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

namespace leonav {
namespace {

using Tracks = std::map<SatelliteId, std::vector<OrbitNode>>;

void append(const std::string& path, Tracks* tracks) {
  for (const Sp3Epoch& epoch : read_sp3(path).epochs) {
    for (const PreciseState& s : epoch.states) {
      auto& nodes = (*tracks)[s.satellite];
      if (nodes.empty() || nodes.back().time < s.time) {
        OrbitNode node;
        node.time = s.time;
        node.p_e = s.p_e;
        node.clock_s = std::isnan(s.clock_s) ? 0.0 : s.clock_s;
        nodes.push_back(node);
      }
    }
  }
}

// Distance of every node from what its neighbours, twice as far apart, say; sorted.
std::vector<double> leave_one_out(const Tracks& tracks, double max_gap_s) {
  std::vector<double> errors;
  for (const auto& [satellite, nodes] : tracks) {
    for (std::size_t i = 6; i + 6 < nodes.size(); ++i) {
      std::vector<OrbitNode> others(nodes.begin() + static_cast<long>(i) - 6,
                                    nodes.begin() + static_cast<long>(i) + 7);
      others.erase(others.begin() + 6);
      SatelliteState state;
      if (!precise_state(others.data(), others.size(), nodes[i].time, max_gap_s, satellite.system,
                         nullptr, &state))
        continue;
      errors.push_back((state.p_e - nodes[i].p_e).norm());
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

}  // namespace

TEST_CASE("Nodes of 15 and of 5 minutes are met by their neighbours", "[precise_orbit][data]") {
  struct Row {
    const char* path;
    double max_gap_s, p50_m, p99_m;
  };
  for (const Row& row : {Row{"station/GRG0MGXFIN_2020177_15M.sp3", 1801.0, 0.01, 0.1},
                         Row{"drive/COD0MGXFIN_20211180000_05M_ORB.SP3", 601.0, 0.005, 0.02}}) {
    if (!test::have_shared_data(row.path)) continue;
    Tracks tracks;
    append(test::shared_data(row.path), &tracks);
    const auto errors = leave_one_out(tracks, row.max_gap_s);
    REQUIRE(errors.size() > 1000);
    std::cout << row.path << ": " << errors.size() << " nodes left out, " << quantile(errors, 0.5)
              << " m median, " << quantile(errors, 0.99) << " m 99 %, " << errors.back()
              << " m worst\n";
    CHECK(quantile(errors, 0.5) < row.p50_m);
    CHECK(quantile(errors, 0.99) < row.p99_m);
  }
}

TEST_CASE("Nodes of 5 minutes are met by every third of them", "[precise_orbit][data]") {
  const char* path = "drive/COD0MGXFIN_20211180000_05M_ORB.SP3";
  if (!test::have_shared_data(path)) return;
  Tracks tracks;
  append(test::shared_data(path), &tracks);
  std::vector<double> errors;
  for (const auto& [satellite, nodes] : tracks) {
    std::vector<OrbitNode> thinned;
    for (std::size_t i = 0; i < nodes.size(); i += 3) thinned.push_back(nodes[i]);
    // Seven nodes on each side.
    for (std::size_t i = 3 * 6; i + 3 * 6 < nodes.size(); ++i) {
      if (i % 3 == 0) continue;
      SatelliteState state;
      REQUIRE(precise_state(thinned.data(), thinned.size(), nodes[i].time, 901.0, satellite.system,
                            nullptr, &state));
      errors.push_back((state.p_e - nodes[i].p_e).norm());
    }
  }
  std::sort(errors.begin(), errors.end());
  REQUIRE(errors.size() > 2000);
  std::cout << path << " by every third node: " << errors.size() << " nodes, "
            << quantile(errors, 0.5) << " m median, " << quantile(errors, 0.99) << " m 99 %, "
            << errors.back() << " m worst\n";
  // The file's own noise: it does not change between degrees 11 and 17.
  CHECK(quantile(errors, 0.5) < 1.2e-3);
  CHECK(quantile(errors, 0.99) < 3e-3);
  CHECK(errors.back() < 5e-3);
}

TEST_CASE("Broadcast and precise orbits agree to metres", "[precise_orbit][data]") {
  if (!test::have_shared_data("station/ESBC00DNK_2020177.nav")) return;
  Tracks tracks;
  append(test::shared_data("station/GRG0MGXFIN_2020177_15M.sp3"), &tracks);
  std::vector<Ephemeris> ephemerides =
      read_navigation(test::shared_data("station/ESBC00DNK_2020177.nav")).ephemerides;
  std::stable_sort(ephemerides.begin(), ephemerides.end(),
                   [](const Ephemeris& a, const Ephemeris& b) {
                     return a.transmission_time < b.transmission_time;
                   });
  EphemerisConfig options;
  options.use_precise = false;
  EphemerisStore ephemeris_store(options);

  struct Differences {
    std::vector<double> orbit, clock;
  };
  std::map<System, Differences> differences;
  const GpsTime first = tracks.begin()->second.front().time;
  auto next = ephemerides.begin();
  for (int minute = 120; minute < 1320; minute += 10) {
    const GpsTime t = first.plus_seconds(60.0 * minute);
    for (; next != ephemerides.end() && next->transmission_time <= t; ++next)
      ephemeris_store.add(*next);
    std::map<System, std::vector<double>> clocks;
    for (const auto& [satellite, nodes] : tracks) {
      SatelliteState precise, broadcast;
      if (!precise_state(nodes.data(), nodes.size(), t, 1000.0, satellite.system, nullptr,
                         &precise))
        continue;
      if (precise.clock_s == 0.0) continue;
      if (ephemeris_store.state_at(satellite, t, &broadcast) != LookupStatus::kOk) continue;
      differences[satellite.system].orbit.push_back((precise.p_e - broadcast.p_e).norm());
      clocks[satellite.system].push_back((precise.clock_s - broadcast.clock_s) * 299792458.0);
      CHECK((precise.v_e - broadcast.v_e).norm() < 0.01);
    }
    // The products' time scales differ: against the median of the epoch.
    for (auto& [system, values] : clocks) {
      std::sort(values.begin(), values.end());
      const double middle = values[values.size() / 2];
      for (const double v : values) differences[system].clock.push_back(std::abs(v - middle));
    }
  }
  for (const System system : {System::kGps, System::kGalileo}) {
    auto& [orbit, clock] = differences[system];
    REQUIRE(orbit.size() > 500);
    std::sort(orbit.begin(), orbit.end());
    std::sort(clock.begin(), clock.end());
    std::cout << to_string(system) << ": precise - broadcast orbit " << quantile(orbit, 0.5)
              << " m median, " << quantile(orbit, 0.95) << " m 95 %, " << orbit.back()
              << " m worst; clock " << quantile(clock, 0.5) << " m median, "
              << quantile(clock, 0.95) << " m 95 %, " << clock.back() << " m worst\n";
    // Centre of mass against antenna: 1 to 2.8 m for GPS, 0.7 to 1.1 m for Galileo.
    CHECK(quantile(orbit, 0.5) < 3.0);
    CHECK(quantile(orbit, 0.95) < 5.0);
    CHECK(quantile(clock, 0.95) < 4.0);
  }
}

}  // namespace leonav
