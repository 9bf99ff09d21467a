// A recorded epoch, generated sets and a transcoded recording of navigation bits through RTKLIB's
// convbin. The version of Debian 12 reads GPS and Galileo sets and observations; of BeiDou no
// navigation data.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "drivers/ubx/walk_recording.h"
#include "oracle_programs.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/recorded/ephemeris_elements.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

// RINEX holds three decimals; half of the last one, and the rounding of the sum itself.
constexpr double kHalfDigit = 0.0005 + 1e-6;

// Half a unit of the twelfth significant digit, as convbin prints them, and a little more.
double last_digit(double value) {
  if (value == 0.0) return 0.0;
  return 0.5001e-12 * std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1.0);
}

using SetKey = std::tuple<SatelliteId, NavigationMessage, GpsTime>;
SetKey key_of(const Ephemeris& e) { return {e.satellite, e.message, e.toe}; }

std::vector<std::uint8_t> oracle_bytes(const std::string& arguments) {
  const test::TemporaryFile place("made.sbf", "");
  REQUIRE(test::run(test::sbf_oracle() + arguments + " >'" + place.path() + "'"));
  return test::stream_bytes(place.path());
}

// This version of convbin writes the block's number of a Galileo message, 2 or 16, where RINEX has
// bits: I/NAV of E1 with its clock, or F/NAV with its own. A delay of -2e10 s, which says that
// F/NAV has none of E5b, it takes for one.
std::string as_rinex(std::string text) {
  const std::string week = "  .236700000000D+04";
  const std::pair<std::string, std::string> changes[] = {
      {".200000000000D+01" + week, ".513000000000D+03" + week},
      {".160000000000D+02" + week, ".258000000000D+03" + week},
      {"-.200000000000D+11", " .000000000000D+00"}};
  for (const auto& [wrong, right] : changes) {
    for (std::size_t at = 0; (at = text.find(wrong, at)) != std::string::npos;) {
      text.replace(at, wrong.size(), right);
    }
  }
  return text;
}

NavigationFile convbin_sets(const std::vector<std::uint8_t>& bytes) {
  const test::TemporaryFile stream("stream.sbf", std::string(bytes.begin(), bytes.end()));
  REQUIRE(test::run("convbin -r sbf -v 3.04 -o '" + stream.beside("x.obs") + "' -n '" +
                    stream.beside("x.nav") + "' '" + stream.path() + "' >/dev/null 2>&1"));
  const auto written = test::stream_bytes(stream.beside("x.nav"));
  const test::TemporaryFile sets("x.nav", as_rinex(std::string(written.begin(), written.end())));
  return read_navigation(sets.path());
}

// Checks the elements of two sets, printed with twelve digits, but for those left out.
void check_elements(const Ephemeris& ours, const Ephemeris& theirs,
                    const std::set<std::size_t>& left_out = {}) {
  const auto a = test::elements_of(ours), b = test::elements_of(theirs);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (left_out.contains(i)) continue;
    CAPTURE(i, a[i], b[i]);
    CHECK(std::abs(a[i] - b[i]) <= last_digit(a[i]));
  }
}

}  // namespace

TEST_CASE("A recorded epoch agrees with convbin's RINEX in every value") {
  if (!test::have_program("convbin") || !test::have_shared_data(test::kX5Epoch)) return;
  const std::string path = test::shared_data(test::kX5Epoch);
  const test::TemporaryFile place("stream.sbf", "");
  REQUIRE(test::run("convbin -r sbf -v 3.04 -os -od -o '" + place.beside("rinex.obs") + "' '" +
                    path + "' >/dev/null 2>&1"));
  const auto ours = test::decode_recorded(test::kX5Epoch);
  REQUIRE(ours.epochs.size() == 1);
  ObservationReader reader(place.beside("rinex.obs"));
  RawEpoch theirs;
  REQUIRE(reader.next(&theirs));
  REQUIRE(theirs.time == ours.epochs[0].time);
  std::map<std::pair<SatelliteId, SignalCode>, SignalObservation> there;
  for (const auto& o : theirs.observations) there[{o.satellite, o.code}] = o;
  long common = 0, unlocked = 0;
  std::map<char, long> only_ours;
  for (const SignalObservation& o : ours.epochs[0].observations) {
    CAPTURE(to_string(o.satellite), to_string(o.code));
    const auto found = there.find({o.satellite, o.code});
    if (found == there.end()) {
      ++only_ours[to_string(o.satellite)[0]];
      continue;
    }
    const SignalObservation& t = found->second;
    ++common;
    CHECK(std::abs(o.pseudorange_m - t.pseudorange_m) <= kHalfDigit);
    CHECK(std::abs(o.doppler_hz - t.doppler_hz) <= kHalfDigit + std::abs(o.doppler_hz) * 0x1p-24);
    // This version of convbin prints quarters of a dB-Hz as thousandths of one.
    CHECK(std::abs(o.cn0_dbhz - t.cn0_dbhz * 250.0) <= 1e-6);
    if (std::isnan(o.carrier_cycles)) {
      // It also takes the value of a slave's carrier that means "not measured" for an offset.
      ++unlocked;
      const double cycles = o.pseudorange_m / wavelength_m(o.satellite.system, o.code.band);
      CHECK(std::abs(t.carrier_cycles - (cycles - 8388.608)) <= kHalfDigit);
    } else {
      CHECK(std::abs(o.carrier_cycles - t.carrier_cycles) <= kHalfDigit);
    }
    there.erase(found);
  }
  CHECK(there.empty());
  CHECK(common == 58);
  CHECK(unlocked == 1);
  // It knows no C36 to C63 and no E31 to E36, and keeps one of E5a and E5b.
  CHECK(only_ours == std::map<char, long>{{'C', 6}, {'E', 14}});
}

TEST_CASE("Generated GPSNav and GALNav agree with convbin's sets to the twelfth digit") {
  if (!test::have_program("convbin")) return;
  const auto bytes = oracle_bytes("generate 4");
  const auto ours = test::decode_sbf(bytes);
  const NavigationFile theirs = convbin_sets(bytes);
  // Several random sets may have one satellite and time: each of ours must be there.
  std::multimap<SetKey, Ephemeris> by_key;
  for (const Ephemeris& t : theirs.ephemerides) by_key.insert({key_of(t), t});
  long compared = 0;
  for (const Ephemeris& o : ours.ephemerides) {
    if (o.satellite.system == System::kBeidou) continue;
    const auto [first, last] = by_key.equal_range(key_of(o));
    const auto same = std::find_if(first, last, [&o](const auto& each) {
      return std::abs(each.second.m0 - o.m0) <= last_digit(o.m0);
    });
    if (same == last) continue;
    CAPTURE(to_string(o.satellite), static_cast<int>(o.message));
    CHECK(o.toc == same->second.toc);
    CHECK(o.issue == same->second.issue);
    check_elements(o, same->second);
    ++compared;
  }
  CHECK(compared > 590);
}

// The recording's subframes, arranged as Septentrio arranges them, must give the ephemerides that
// RTKLIB made of the recording itself.
TEST_CASE("Raw navigation bits of GPS, Galileo and BeiDou give RTKLIB's ephemerides") {
  if (!test::have_shared_data(test::kWalkUbx) || !test::have_shared_data("walk/gnss.nav")) return;
  const auto bytes = oracle_bytes("transcode '" + test::shared_data(test::kWalkUbx) + "'");
  const auto ours = test::decode_sbf(bytes);
  const NavigationFile theirs = read_navigation(test::shared_data("walk/gnss.nav"));
  std::map<SetKey, Ephemeris> by_key;
  for (const Ephemeris& e : ours.ephemerides) by_key[key_of(e)] = e;
  std::set<SatelliteId> satellites;
  for (const Ephemeris& t : theirs.ephemerides) {
    CAPTURE(to_string(t.satellite), static_cast<int>(t.message), t.toe.tow_s());
    REQUIRE(by_key.contains(key_of(t)));
    const Ephemeris& o = by_key[key_of(t)];
    CHECK(o.toc == t.toc);
    CHECK(o.health == t.health);
    CHECK(o.accuracy_m == Approx(t.accuracy_m).epsilon(1e-12));
    if (t.satellite.system != System::kBeidou) CHECK(o.issue == t.issue);
    check_elements(o, t);
    satellites.insert(t.satellite);
  }
  CHECK(satellites.size() == 19);
  // The same subframes as in u-blox's own arrangement, none lost on the way; those with the delays
  // of CNAV, B-CNAV1 and B-CNAV2 are in other blocks of Septentrio's.
  constexpr std::uint64_t kWithDelays = 44 + 51 + 18;
  const auto recorded = test::decode_walk();
  CHECK(ours.counters.navigation.subframes + kWithDelays == recorded.counters.sfrbx.subframes);
  CHECK(ours.counters.navigation.bad_parity == recorded.counters.sfrbx.bad_parity);
  const auto of_bcnav1 = std::count_if(recorded.ephemerides.begin(), recorded.ephemerides.end(),
                                       is_for_corrections_alone);
  CHECK(ours.ephemerides.size() + static_cast<std::size_t>(of_bcnav1) ==
        recorded.ephemerides.size());
}

// This version of convbin takes the last 16 bits of a word from another place of the page. What it
// makes of them contradicts what it makes of the same pages in u-blox's arrangement, with which the
// test before agrees: sqrt A, i dot, Crs, af1, af2.
TEST_CASE("Raw I/NAV pages give convbin's ephemerides in what it reads rightly") {
  if (!test::have_program("convbin") || !test::have_shared_data(test::kWalkUbx)) return;
  const std::set<std::size_t> at_the_end = {0, 7, 12, 16, 17};
  const auto bytes = oracle_bytes("transcode '" + test::shared_data(test::kWalkUbx) + "'");
  const NavigationFile theirs = convbin_sets(bytes);
  std::map<SetKey, Ephemeris> by_key;
  for (const Ephemeris& e : test::decode_sbf(bytes).ephemerides) by_key[key_of(e)] = e;
  CHECK(theirs.ephemerides.size() == 6);
  for (const Ephemeris& t : theirs.ephemerides) {
    CAPTURE(to_string(t.satellite), t.toe.tow_s());
    REQUIRE(by_key.contains(key_of(t)));
    check_elements(by_key[key_of(t)], t, at_the_end);
  }
}

}  // namespace leonav
