// Elements of B-CNAV1 in the recorded walk: against the PyPI package cssrlib, against those of D1
// of the same satellites, and damaged ones.
#include "drivers/navigation_bits/beidou_cnav1.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"
#include "drivers/navigation_bits/navigation_collector.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using Sets = std::map<SatelliteId, Ephemeris>;

Sets sets_of(const std::vector<Ephemeris>& all, NavigationMessage message) {
  Sets sets;
  for (const Ephemeris& e : all) {
    if (e.message == message) sets[e.satellite] = e;
  }
  return sets;
}

std::string cnav1_oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/bcnav1.py' ";
}

const GpsTime kNow = GpsTime::from_week_and_tow(2381, 403'000.0);
constexpr SatelliteId kC21{System::kBeidou, 21};

// Subframe 2 with the fields that are checked, and plain elements.
struct Subframe2 {
  std::uint32_t week = 2381 - 1356, hour = 111, iodc = 0x101, iode = 1, toe = 1343, orbit_type = 3;

  std::array<std::uint8_t, 75> bits() const {
    BitWriter<75> writer;
    writer.put(week, 13);
    writer.put(hour, 8);
    writer.put(iodc, 10);
    writer.put(iode, 8);
    writer.put(toe, 11);
    writer.put(orbit_type, 2);
    while (writer.position() < 39 + 203 + 222) writer.put(0, 1);
    writer.put(1344, 11);
    while (writer.position() < 576) writer.put(0, 1);
    writer.put(crc24q(BitReader(writer.bytes()), 576), 24);
    return writer.bytes();
  }
};

SubframeStatus read(const Subframe2& subframe, Ephemeris* e) {
  return read_bcnav1_elements(subframe.bits(), {kC21, kNow}, e);
}

}  // namespace

TEST_CASE("Every element of the walk's B-CNAV1 is that of cssrlib") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  if (std::system((cnav1_oracle() + "--have >/dev/null 2>&1").c_str()) != 0) {
    std::cout << "SKIPPED (optional): no Python with cssrlib (LEONAV_PYTHON names another)\n";
    return;
  }
  const test::TemporaryFile output("sets.txt", "");
  REQUIRE(std::system((cnav1_oracle() + "'" + test::shared_data(test::kWalkUbx) + "' >'" +
                       output.path() + "'")
                          .c_str()) == 0);
  const Sets ours = sets_of(test::decode_walk().ephemerides, NavigationMessage::kBeidouCnav1);
  std::ifstream file(output.path());
  int lines = 0;
  for (std::string line; std::getline(file, line); ++lines) {
    std::istringstream words(line);
    std::string satellite;
    words >> satellite;
    std::vector<double> theirs;
    for (std::string word; words >> word;) theirs.push_back(std::strtod(word.c_str(), nullptr));
    REQUIRE(theirs.size() == 4 + 20 + 4);
    CAPTURE(satellite);
    const Ephemeris& e = ours.at(*satellite_from_string(satellite));
    CHECK(e.issue == theirs[0]);
    CHECK(e.issue_clock == theirs[1]);
    CHECK(e.toe.tow_s() == theirs[2] + 14.0);
    CHECK(e.toc.tow_s() == theirs[3] + 14.0);
    const double elements[] = {e.sqrt_a * e.sqrt_a,
                               e.eccentricity,
                               e.m0,
                               e.delta_n,
                               e.omega0,
                               e.omega_dot,
                               e.i0,
                               e.i_dot,
                               e.omega,
                               e.cuc,
                               e.cus,
                               e.crc,
                               e.crs,
                               e.cic,
                               e.cis,
                               e.af0,
                               e.af1,
                               e.af2,
                               e.a_dot,
                               e.delta_n_dot};
    for (std::size_t i = 0; i < std::size(elements); ++i) {
      CAPTURE(i);
      // cssrlib takes pi with the 13 digits of the documents.
      CHECK(elements[i] == Approx(theirs[4 + i]).epsilon(1e-14).margin(0.0));
    }
    const SatelliteState state = broadcast_state(e, e.toe.plus_seconds(1000.0));
    const Eigen::Vector3d p(theirs[24], theirs[25], theirs[26]);
    CHECK((state.p_e - p).norm() < 1e-5);
    CHECK(kSpeedOfLight * std::abs(state.clock_s - theirs[27]) < 1e-5);
    // cssrlib's velocity leaves rates of harmonic terms out: the positions' difference it is.
    const auto p_at = [&e](double s) { return broadcast_state(e, e.toe.plus_seconds(s)).p_e; };
    CHECK((state.v_e - (p_at(1000.5) - p_at(999.5))).norm() < 1e-5);
  }
  CHECK(lines == 51);
  CHECK(ours.size() == 8);
}

// Both messages describe one orbit. Their clocks refer to B3I.
TEST_CASE("Orbits and clocks of B-CNAV1 are those of D1 of the same satellites within metres") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const auto walk = test::decode_walk();
  const Sets d1 = sets_of(walk.ephemerides, NavigationMessage::kBeidouD1);
  int compared = 0;
  double worst_m = 0.0, worst_clock_m = 0.0;
  for (const auto& [satellite, e] : sets_of(walk.ephemerides, NavigationMessage::kBeidouCnav1)) {
    CAPTURE(to_string(satellite));
    CHECK(is_sane(e));
    CHECK(is_for_corrections_alone(e));
    if (!d1.contains(satellite)) continue;
    const SatelliteState a = broadcast_state(e, walk.epochs.back().time);
    const SatelliteState b = broadcast_state(d1.at(satellite), walk.epochs.back().time);
    const double clock_m = kSpeedOfLight * std::abs(a.clock_s - b.clock_s);
    CHECK((a.p_e - b.p_e).norm() < 3.0);
    CHECK((a.v_e - b.v_e).norm() < 1e-3);
    CHECK(clock_m < 3.0);
    worst_m = std::max(worst_m, (a.p_e - b.p_e).norm());
    worst_clock_m = std::max(worst_clock_m, clock_m);
    ++compared;
  }
  CHECK(compared >= 6);
  std::cout << "B-CNAV1 against D1: " << compared << " satellites, positions within " << worst_m
            << " m, clocks within " << worst_clock_m << " m\n";
}

TEST_CASE("A set of B-CNAV1 has the times and axes of its fields") {
  Ephemeris e;
  REQUIRE(read({}, &e) == SubframeStatus::kUsed);
  CHECK(e.satellite == kC21);
  CHECK(e.issue == 1);
  CHECK(e.issue_clock == 0x101);
  CHECK(e.toe == GpsTime::from_week_and_tow(2381, 1343 * 300.0 + 14.0));
  CHECK(e.toc == GpsTime::from_week_and_tow(2381, 1344 * 300.0 + 14.0));
  CHECK(e.transmission_time == kNow);
  CHECK(e.sqrt_a * e.sqrt_a == Approx(27'906'100.0).epsilon(1e-15));
  CHECK(is_sane(e));
  REQUIRE(read({.orbit_type = 2}, &e) == SubframeStatus::kUsed);
  CHECK(e.sqrt_a * e.sqrt_a == Approx(42'162'200.0).epsilon(1e-15));
  e.satellite = {System::kBeidou, 59};  // geostationary satellites send no B1C
  CHECK_FALSE(is_sane(e));
}

TEST_CASE("A set of B-CNAV1 that contradicts itself or the time is refused") {
  Ephemeris e;
  CHECK(read({.week = 2378 - 1356}, &e) == SubframeStatus::kBadWeek);
  CHECK(read({.hour = 168}, &e) == SubframeStatus::kBadWeek);
  CHECK(read({.iode = 2}, &e) == SubframeStatus::kBadParity);
  CHECK(read({.orbit_type = 0}, &e) == SubframeStatus::kBadParity);
  NavigationCollector collector;
  auto damaged = Subframe2{}.bits();
  damaged[20] ^= 4;
  CHECK_FALSE(collector.add_bcnav1(damaged, {kC21, kNow}).ephemeris);
  CHECK_FALSE(collector.add_bcnav1(Subframe2{.week = 7}.bits(), {kC21, kNow}).ephemeris);
  CHECK(collector.counters().bad_parity == 1);
  CHECK(collector.counters().bad_week == 1);
  CHECK(collector.counters().ephemerides == 0);
  const NavigationUpdate first = collector.add_bcnav1(Subframe2{}.bits(), {kC21, kNow});
  CHECK(first.ephemeris);
  CHECK(first.biases.size() == 4);
  CHECK_FALSE(collector.add_bcnav1(Subframe2{}.bits(), {kC21, kNow}).ephemeris);
  CHECK(collector.counters().ephemerides == 1);
}

}  // namespace leonav
