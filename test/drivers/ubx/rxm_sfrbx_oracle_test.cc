// SFRBX against RTKLIB's convbin: every ephemeris of walk/gnss.nav.
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "drivers/rinex/navigation_reader.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "support/recorded/ephemeris_elements.h"

namespace leonav {
namespace {

using Key = std::tuple<SatelliteId, NavigationMessage, GpsTime>;
Key key_of(const Ephemeris& e) { return {e.satellite, e.message, e.toe}; }

// Half a unit of the twelfth significant digit, as convbin prints them, and a little for the
// rounding of the comparison.
double last_digit(double value) {
  if (value == 0.0) return 0.0;
  return 0.5001e-12 * std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1.0);
}

}  // namespace

TEST_CASE("Ephemerides agree with RTKLIB's in every field") {
  if (!test::have_shared_data(test::kWalkUbx) || !test::have_shared_data("walk/gnss.nav")) return;
  const auto ours = test::decode_walk();
  const NavigationFile theirs = read_navigation(test::shared_data("walk/gnss.nav"));
  REQUIRE(theirs.ephemerides.size() >= 19);

  std::map<Key, Ephemeris> by_key;
  std::set<SatelliteId> satellites;
  for (const Ephemeris& e : ours.ephemerides) {
    if (is_for_corrections_alone(e)) continue;  // B-CNAV1, which convbin does not read
    by_key[key_of(e)] = e;
    satellites.insert(e.satellite);
  }
  std::set<SatelliteId> their_satellites;
  for (const Ephemeris& t : theirs.ephemerides) {
    their_satellites.insert(t.satellite);
    CAPTURE(to_string(t.satellite), static_cast<int>(t.message), t.toe.tow_s());
    REQUIRE(by_key.contains(key_of(t)));
    const Ephemeris& o = by_key[key_of(t)];
    CHECK(o.toc == t.toc);
    CHECK(o.health == t.health);
    // SISA 3.12 m has no exact binary form.
    CHECK(o.accuracy_m == Approx(t.accuracy_m).epsilon(1e-12));
    // For BeiDou convbin puts a number of its own making where the age of data belongs.
    if (t.satellite.system != System::kBeidou) CHECK(o.issue == t.issue);
    if (t.satellite.system == System::kGps) CHECK(o.issue_clock == t.issue_clock);
    const auto a = test::elements_of(o), b = test::elements_of(t);
    for (std::size_t i = 0; i < a.size(); ++i) {
      CAPTURE(i, a[i], b[i]);
      CHECK(std::abs(a[i] - b[i]) <= last_digit(a[i]));
    }
  }
  CHECK(their_satellites.size() == 19);
  CHECK(satellites == their_satellites);
}

TEST_CASE("The walk's subframes are counted to the last one") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const auto ours = test::decode_walk();
  const RxmSfrbxCounters& c = ours.counters.sfrbx;
  CHECK(c.subframes == 353 + 44 + 51 + 18);  // and CNAV's, B-CNAV1's, B-CNAV2's with delays
  CHECK(c.ephemerides == 30 + 8);            // of B-CNAV1 eight
  CHECK(c.other_system == 307);              // SBAS
  CHECK(c.pages == 634);                     // Galileo's high accuracy service
  CHECK(ours.pages.size() == 634);
  CHECK(c.other_message == 1033 - 44 - 51 - 18);  // other types of CNAV and B-CNAV, almanacs
  // C36, at the edge of reception: ten words with good check bits whose second of week is 639,xxx.
  CHECK(c.bad_parity == 1);
  CHECK(c.bad_week + c.wrong_satellite + c.without_time + c.not_sane == 0);
  CHECK(c.bad_length + c.bad_version + c.bad_satellite == 0);
  CHECK(ours.klobuchars.empty());  // page 18 comes every 12.5 minutes; the walk takes two
}

}  // namespace leonav
