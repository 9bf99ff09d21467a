// Recordings that are damaged or unusual, from the file to the table of results, as a user would.
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/recorded/shared_data.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {
namespace {

using Catch::Contains;

struct Table {
  std::vector<std::map<std::string, std::string>> rows;
};
Table read_table(const std::string& path) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  const auto names = split(line);
  Table table;
  while (std::getline(file, line)) {
    const auto cells = split(line);
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
    table.rows.push_back(row);
  }
  return table;
}

struct ImportAndReplay {
  ProgramRun import, replay;
  Table solution, satellites;
};
ImportAndReplay run_files(const TemporaryFile& yaml, const std::string& replay_options) {
  ImportAndReplay result;
  const std::string log = yaml.beside("run.lcmlog"), out = yaml.beside("result");
  result.import = run_program("leonav-import", yaml.path() + " -o " + log);
  result.replay = run_program("leonav-replay", replay_options + " --out " + out + " " + log);
  result.solution = read_table(out + "/solution.csv");
  result.satellites = read_table(out + "/satellites.csv");
  return result;
}
const std::string kStation = "--preset station";

TEST_CASE("a RINEX file that ends in the middle of an epoch: the epochs before it are answered") {
  const std::string name = "station/ESBC00DNK_2020177_6H_30S.obs";
  if (!have_programs("leonav-import", "leonav-replay") || !have_shared_data(name)) return;
  const std::string whole = text_of(shared_data(name));
  std::size_t cut = 0;  // in the middle of the 41st epoch
  for (int epoch = 0; epoch < 41; ++epoch) cut = whole.find("\n>", cut) + 1;
  cut = whole.find("\nE", cut) + 40;
  const TemporaryFile yaml("set.yaml", "name: s\nobservations: cut.obs\nnavigation: " +
                                           shared_data("station/ESBC00DNK_2020177.nav") + "\n");
  std::ofstream(yaml.beside("cut.obs"), std::ios::binary) << whole.substr(0, cut);
  const ImportAndReplay result = run_files(yaml, kStation);
  CAPTURE(result.import.out, result.import.err, result.replay.err);
  CHECK(result.import.exit_code == 0);
  CHECK_THAT(result.import.out + result.import.err, Contains("cut off"));
  CHECK(result.replay.exit_code == 0);
  CHECK(result.solution.rows.size() == 40);
}

TEST_CASE("a UBX recording with flipped bits loses the messages they are in") {
  if (!have_programs("leonav-import", "leonav-replay") || !have_shared_data("walk/gnss.ubx"))
    return;
  const std::string whole = text_of(shared_data("walk/gnss.ubx"));
  const auto answer = [&](const std::string& bytes) {
    const TemporaryFile yaml("set.yaml", "name: s\nobservations: walk.ubx\nnavigation: " +
                                             shared_data("walk/gnss.nav") + "\n");
    std::ofstream(yaml.beside("walk.ubx"), std::ios::binary) << bytes;
    return run_files(yaml, "--preset walk --set ekf.motion=constant_velocity");
  };
  const ImportAndReplay clean = answer(whole);
  std::string damaged = whole;
  constexpr std::size_t kFlips = 60;
  for (std::size_t i = 0; i < kFlips; ++i) {
    damaged[(2 * i + 1) * whole.size() / (2 * kFlips)] ^= static_cast<char>(1 << (i % 8));
  }
  const ImportAndReplay hurt = answer(damaged);
  CAPTURE(clean.import.err, clean.replay.err, hurt.import.out, hurt.import.err, hurt.replay.err);
  CHECK(hurt.import.exit_code == 0);
  CHECK(hurt.replay.exit_code == 0);
  CHECK_THAT(hurt.import.out + hurt.import.err, Contains("checksum"));
  REQUIRE(clean.solution.rows.size() > 500);
  CHECK(hurt.solution.rows.size() + kFlips >= clean.solution.rows.size());
  CHECK(hurt.solution.rows.size() < clean.solution.rows.size());
}

// --- more than 99 satellites, LEO ones by letter, approximate position zero ---

struct Crowd {
  SimulatedSky sky;
  SimulatedReceiver receiver;
  std::vector<RawEpoch> epochs;
};

Crowd make_crowd() {
  Crowd crowd;
  // Circular orbits: an SP3 clock leaves out the relativity of eccentricity.
  const std::vector<Walker> walkers = {{System::kGps, 6, 8, 26'560e3, 0.96, 0.0},
                                       {System::kGalileo, 3, 16, 29'600e3, 0.977, 0.0},
                                       {System::kBeidou, 3, 14, 27'906e3, 0.96, 0.0},
                                       {System::kLeo, 18, 22, 8'900e3, 0.96, 0.0}};
  const std::vector<std::vector<std::pair<SignalCode, double>>> signals = {
      {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 45.0}},
      {{{'1', 'C'}, 45.0}, {{'5', 'Q'}, 45.0}},
      {{{'2', 'I'}, 45.0}, {{'6', 'I'}, 45.0}},
      {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 45.0}}};
  crowd.receiver.elevation_mask = 0.0;
  crowd.epochs.resize(5);
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    SimulatedSky one;
    one.add(walkers[i]);
    crowd.sky.add(walkers[i]);
    crowd.receiver.signals = signals[i];
    for (std::size_t k = 0; k < crowd.epochs.size(); ++k) {
      const RawEpoch raw = simulate_epoch(one, crowd.receiver, 30.0 * static_cast<double>(k));
      crowd.epochs[k].time = raw.time;
      for (const SignalObservation& o : raw.observations) {
        crowd.epochs[k].observations.push_back(o);
      }
    }
  }
  return crowd;
}

std::string calendar_text(const char* format, double seconds_since_epoch) {
  const int minutes = static_cast<int>(seconds_since_epoch) / 60;
  char text[80];  // kSkyEpoch is 2022-03-10 00:00:00
  std::snprintf(text, sizeof text, format, minutes / 60, minutes % 60,
                seconds_since_epoch - 60.0 * minutes);
  return text;
}

std::string rinex_line(std::string content, const std::string& label) {
  content.resize(60, ' ');
  return content + label + "\n";
}

std::string rinex_of(const Crowd& crowd) {
  std::string text =
      rinex_line("     3.05           OBSERVATION DATA    M", "RINEX VERSION / TYPE") +
      rinex_line("        0.0000        0.0000        0.0000", "APPROX POSITION XYZ");
  for (const char* types : {"G    4 C1C D1C C2W D2W", "E    4 C1C D1C C5Q D5Q",
                            "C    4 C2I D2I C6I D6I", "L    4 C1C D1C C2W D2W"}) {
    text += rinex_line(types, "SYS / # / OBS TYPES");
  }
  text += rinex_line("  2022    03    10    00    00    0.0000000     GPS", "TIME OF FIRST OBS") +
          rinex_line("", "END OF HEADER");
  for (std::size_t k = 0; k < crowd.epochs.size(); ++k) {
    std::string body;
    int satellites = 0;
    SatelliteId last;
    for (const SignalObservation& o : crowd.epochs[k].observations) {
      if (satellites == 0 || o.satellite != last) {
        body += (satellites == 0 ? "" : "\n") + to_string(o.satellite);
        last = o.satellite;
        ++satellites;
      }
      char fields[48];
      std::snprintf(fields, sizeof fields, "%14.3f  %14.3f  ", o.pseudorange_m, o.doppler_hz);
      body += fields;
    }
    char count[16];
    std::snprintf(count, sizeof count, "  0%3d\n", satellites);
    text += calendar_text("> 2022 03 10 %02d %02d %10.7f", 30.0 * static_cast<double>(k)) + count +
            body + "\n";
  }
  return text;
}

// Orbits of everything, a node a minute, from five minutes before to fifteen after.
std::string sp3_of(const Crowd& crowd) {
  std::string text =
      "#dP2022  3  9 23 55  0.00000000      21 ORBIT IGS20 HLM  IGS\n"
      "## 2200 345300.00000000    60.00000000 59647 0.9965277777778\n"
      "%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
  for (int node = -5; node <= 15; ++node) {
    text += node < 0 ? "*  2022  3  9 23 " + std::to_string(60 + node) + "  0.00000000\n"
                     : calendar_text("*  2022  3 10 %2d %2d %11.8f\n", 60.0 * node);
    for (const Ephemeris& e : crowd.sky.ephemerides) {
      const SatelliteState state = broadcast_state(e, kSkyEpoch.plus_seconds(60.0 * node));
      char line[96];
      std::snprintf(line, sizeof line, "P%s%14.6f%14.6f%14.6f%14.6f\n",
                    to_string(e.satellite).c_str(), state.p_e.x() * 1e-3, state.p_e.y() * 1e-3,
                    state.p_e.z() * 1e-3, state.clock_s * 1e6);
      text += line;
    }
  }
  return text + "EOF\n";
}

TEST_CASE("a file with more than 99 satellites and an approximate position of zero just works") {
  if (!have_programs("leonav-import", "leonav-replay")) return;
  const Crowd crowd = make_crowd();
  std::set<SatelliteId> satellites;
  std::size_t expected_rows = 0;
  std::set<std::string> leo_letters;
  for (const RawEpoch& raw : crowd.epochs) {
    std::set<SatelliteId> of_epoch;
    for (const SignalObservation& o : raw.observations) of_epoch.insert(o.satellite);
    REQUIRE(of_epoch.size() > 99);
    REQUIRE(of_epoch.size() <= kMaxSatellites);
    expected_rows += of_epoch.size();
    satellites.insert(of_epoch.begin(), of_epoch.end());
  }
  for (const SatelliteId id : satellites) leo_letters.insert(to_string(id).substr(0, 1));
  CHECK(leo_letters.size() >= 6);  // G, E, C, and LEO of several hundreds
  const TemporaryFile yaml("set.yaml", "name: s\nobservations: crowd.obs\norbits: crowd.sp3\n");
  std::ofstream(yaml.beside("crowd.obs")) << rinex_of(crowd);
  std::ofstream(yaml.beside("crowd.sp3")) << sp3_of(crowd);
  const ImportAndReplay result =
      run_files(yaml, kStation + " --set gnss.systems=[gps,galileo,beidou,leo]");
  CAPTURE(result.import.out, result.import.err, result.replay.out, result.replay.err);
  CHECK(result.import.exit_code == 0);
  CHECK(result.replay.exit_code == 0);
  REQUIRE(result.solution.rows.size() == crowd.epochs.size());
  for (const auto& row : result.solution.rows) {
    const Eigen::Vector3d p_e =
        to_ecef({std::stod(row.at("latitude_deg")) * kDegree,
                 std::stod(row.at("longitude_deg")) * kDegree, std::stod(row.at("height_m"))});
    CHECK((p_e - crowd.receiver.p_e).norm() < 2.0);
    CHECK(std::stoi(row.at("satellites")) > 60);
  }

  // Every raw satellite of every epoch is in the table, once, with its reason.
  CHECK(result.satellites.rows.size() == expected_rows);
  std::set<std::pair<std::string, std::string>> seen;
  std::map<std::string, int> reasons;
  for (const auto& row : result.satellites.rows) {
    CHECK(seen.emplace(row.at("gps_tow_s"), row.at("satellite")).second);
    CHECK_FALSE(row.at("reason").empty());
    CHECK((row.at("used") == "1") ==
          (row.at("reason") == "used" || row.at("reason") == "downweighted"));
    ++reasons[row.at("reason")];
  }
  CHECK(reasons["low_elevation"] > 0);
  CHECK(reasons["no_ephemeris"] == 0);
}

}  // namespace
}  // namespace leonav::test
