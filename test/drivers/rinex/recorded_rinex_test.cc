// The recorded files against a scan of their text that shares nothing with the readers.
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Totals {
  long epochs = 0, other_systems = 0, half_cycles = 0, losses = 0;
  std::set<std::string> satellites;
  std::map<char, long> count;  // by observable letter
  std::map<char, double> sum;

  void add(char kind, double value) {
    ++count[kind];
    sum[kind] += value;
  }
};

Totals scan(const std::string& path) {
  Totals totals;
  std::ifstream file(path);
  std::string line, word;
  std::map<char, std::vector<std::string>> types;
  char system = ' ';
  while (std::getline(file, line) && line.find("END OF HEADER") == std::string::npos) {
    if (line.find("SYS / # / OBS TYPES") == std::string::npos) continue;
    if (line[0] != ' ') system = line[0];
    std::istringstream words(line.substr(6, 54));
    while (words >> word) types[system].push_back(word);
  }
  while (std::getline(file, line)) {
    if (line[0] == '>') {
      ++totals.epochs;
    } else if (std::string("GEC").find(line[0]) == std::string::npos) {
      ++totals.other_systems;
    } else {
      line.resize(3 + 16 * types[line[0]].size(), ' ');
      bool any = false;
      for (std::size_t i = 0; i < types[line[0]].size(); ++i) {
        const char kind = types[line[0]][i][0];
        const std::string field = line.substr(3 + 16 * i, 16);
        if (kind == 'L' && field[14] >= '1' && field[14] <= '7') {
          totals.losses += (field[14] - '0') % 2;
          totals.half_cycles += (field[14] - '0') / 2 % 2;
        }
        const double value = std::atof(field.substr(0, 14).c_str());
        if (value == 0.0) continue;
        totals.add(kind, value);
        any = true;
      }
      if (any) totals.satellites.insert(line.substr(0, 3));
    }
  }
  return totals;
}

Totals read_totals(const std::string& path) {
  Totals totals;
  ObservationReader reader(path);
  RawEpoch epoch;
  while (reader.next(&epoch)) {
    for (std::size_t i = 1; i < epoch.observations.size(); ++i) {
      const auto &a = epoch.observations[i - 1], &b = epoch.observations[i];
      REQUIRE(std::pair(a.satellite, a.code) < std::pair(b.satellite, b.code));
    }
    for (const SignalObservation& o : epoch.observations) {
      totals.satellites.insert(to_string(o.satellite));
      if (!std::isnan(o.pseudorange_m)) totals.add('C', o.pseudorange_m);
      if (!std::isnan(o.carrier_cycles)) totals.add('L', o.carrier_cycles);
      if (!std::isnan(o.doppler_hz)) totals.add('D', o.doppler_hz);
      if (!std::isnan(o.cn0_dbhz)) totals.add('S', o.cn0_dbhz);
      totals.half_cycles += o.half_cycle_ambiguous;
    }
  }
  totals.epochs = reader.counts().used;
  totals.other_systems = reader.counts().skipped_total();
  return totals;
}

std::map<char, long> records_by_system(const std::string& path) {
  std::map<char, long> records;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && line.find("END OF HEADER") == std::string::npos) {
  }
  while (std::getline(file, line)) {
    if (line.substr(0, 2) != "  ") ++records[line[0] >= 'A' ? line[0] : 'G'];
  }
  return records;
}

}  // namespace

TEST_CASE("recorded observations: every value and flag counts once", "[rinex][recorded]") {
  for (const char* name :
       {"walk/gnss.obs", "drive/gnss.obs", "station/ESBC00DNK_2020177_6H_30S.obs"}) {
    if (!have_shared_data(name)) continue;
    INFO(name);
    const Totals expected = scan(shared_data(name)), seen = read_totals(shared_data(name));
    CHECK(seen.epochs == expected.epochs);
    CHECK(seen.other_systems == expected.other_systems);
    CHECK(seen.satellites == expected.satellites);
    CHECK(seen.count == expected.count);
    CHECK(seen.half_cycles == expected.half_cycles);
    for (const char kind : {'C', 'L', 'D', 'S'}) {
      CHECK(seen.sum.at(kind) == Approx(expected.sum.at(kind)).epsilon(1e-14));
    }
  }
}

TEST_CASE("recorded navigation: every record of a used system counts", "[rinex][recorded]") {
  for (const char* name :
       {"walk/gnss.nav", "drive/gps.nav", "drive/gps_day.nav", "station/ESBC00DNK_2020177.nav"}) {
    if (!have_shared_data(name)) continue;
    INFO(name);
    std::map<char, long> seen;
    const NavigationFile file = read_navigation(shared_data(name));
    for (const Ephemeris& e : file.ephemerides) {
      ++seen[to_string(e.satellite)[0]];
      CHECK(std::abs(seconds_between(e.toe, e.toc)) <= 7200.0);
    }
    std::map<char, long> expected = records_by_system(shared_data(name));
    long others = 0;
    for (const char other : {'R', 'S', 'J', 'I'}) {
      others += expected[other];
      expected.erase(other);
    }
    CHECK(seen == expected);
    CHECK(file.counts.skipped_total() == others);
  }
}
