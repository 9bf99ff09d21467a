// RINEX 4 navigation files that the PyPI package cssrlib wrote, against the same ephemerides in
// RINEX 3 and in the bits of the recorded walk.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <tuple>

#include "core/gnss/signals/signal.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

std::string rinex4_oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/rinex4.py' ";
}

// Returns what cssrlib writes of a file of the shared data; nothing where either is missing.
std::optional<NavigationFile> written(const std::string& mode, const std::string& name) {
  if (!test::have_shared_data(name)) return std::nullopt;
  if (std::system((rinex4_oracle() + "--have >/dev/null 2>&1").c_str()) != 0) {
    std::cout << "SKIPPED (optional): no Python with cssrlib (LEONAV_PYTHON names another)\n";
    return std::nullopt;
  }
  const test::TemporaryFile output("written.rnx", "");
  REQUIRE(std::system((rinex4_oracle() + mode + " '" + test::shared_data(name) + "' '" +
                       output.path() + "'")
                          .c_str()) == 0);
  return read_navigation(output.path());
}

using IssueKey = std::tuple<SatelliteId, NavigationMessage, GpsTime, std::uint16_t>;
IssueKey issue_key_of(const Ephemeris& e) { return {e.satellite, e.message, e.toe, e.issue}; }

// The file has twelve decimals, and the square root of A that is A in between.
void check_same_elements(const Ephemeris& a, const Ephemeris& b) {
  CAPTURE(to_string(a.satellite), b.toe.tow_s());
  CHECK(a.toc == b.toc);
  CHECK(a.issue_clock == b.issue_clock);
  CHECK(a.health == b.health);
  const auto values = [](const Ephemeris& e) {
    return std::array{e.sqrt_a,    e.eccentricity, e.m0,    e.delta_n, e.omega0,
                      e.omega_dot, e.i0,           e.i_dot, e.omega,   e.cuc,
                      e.cus,       e.crc,          e.crs,   e.cic,     e.cis,
                      e.a_dot,     e.delta_n_dot,  e.af0,   e.af1,     e.af2};
  };
  const auto x = values(a), y = values(b);
  for (std::size_t i = 0; i < x.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(x[i] - y[i]) <= 1e-12 * std::abs(y[i]));
  }
}

}  // namespace

TEST_CASE("Every record that cssrlib writes as RINEX 4 has the elements of the RINEX 3 file",
          "[rinex]") {
  for (const char* name : {"station/ESBC00DNK_2020177.nav", "wire/broadcast_189.23P"}) {
    const auto file = written("convert", name);
    if (!file) return;
    CHECK(file->counts.skipped_total() == 0);
    std::map<IssueKey, Ephemeris> originals;
    const NavigationFile original = read_navigation(test::shared_data(name));
    for (const Ephemeris& e : original.ephemerides) originals.emplace(issue_key_of(e), e);
    std::map<NavigationMessage, int> compared;
    for (const Ephemeris& e : file->ephemerides) {
      const auto found = originals.find(issue_key_of(e));
      CAPTURE(to_string(e.satellite), e.toe.tow_s(), e.issue);
      REQUIRE(found != originals.end());
      check_same_elements(e, found->second);
      if (e.satellite.system != System::kBeidou) {
        CHECK(e.transmission_time == found->second.transmission_time);
      }
      if (e.satellite.system != System::kGalileo) {
        CHECK(e.group_delay_s == found->second.group_delay_s);
      }
      ++compared[e.message];
    }
    for (const NavigationMessage message :
         {NavigationMessage::kGpsLnav, NavigationMessage::kGalileoInav,
          NavigationMessage::kGalileoFnav, NavigationMessage::kBeidouD1}) {
      CHECK(compared[message] >= 16);
    }
    std::cout << name << ": " << file->ephemerides.size() << " records of RINEX 4\n";
  }
}

TEST_CASE("Elements and delays that cssrlib writes of the walk's CNAV and B-CNAV1 are its bits'",
          "[rinex]") {
  const auto file = written("cnav", test::kWalkUbx);
  if (!file) return;
  const auto walk = test::decode_walk();
  std::map<IssueKey, Ephemeris> ours;
  for (const Ephemeris& e : walk.ephemerides) ours.emplace(issue_key_of(e), e);
  CHECK(file->ephemerides.size() == 8);
  for (const Ephemeris& e : file->ephemerides) {
    CHECK(e.message == NavigationMessage::kBeidouCnav1);
    const auto found = ours.find(issue_key_of(e));
    CAPTURE(to_string(e.satellite), e.toe.tow_s(), e.issue);
    REQUIRE(found != ours.end());
    check_same_elements(e, found->second);
  }
  std::map<std::pair<SatelliteId, SignalCode>, double> delays;
  for (const SignalBias& b : walk.biases) delays[{b.satellite, b.code}] = b.bias_m;
  std::map<System, int> compared;
  for (const SignalBias& b : file->delays) {
    CAPTURE(to_string(b.satellite), to_string(b.code));
    // cssrlib leaves the delay of the data of B2a zero, which B-CNAV1 does not have.
    const auto found = delays.find({b.satellite, b.code});
    if (found == delays.end()) continue;
    CHECK(b.bias_m == Approx(found->second).epsilon(1e-11).margin(1e-9));
    CHECK(b.kind == BiasKind::kBroadcastCode);
    ++compared[b.satellite.system];
  }
  CHECK(compared[System::kGps] == 2 * 11);
  CHECK(compared[System::kBeidou] == 8 * 4);
}

}  // namespace leonav
