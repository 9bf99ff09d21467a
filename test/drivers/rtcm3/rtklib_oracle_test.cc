// The same bytes through RTKLIB: convbin's RINEX of them, and RTCM 3 that str2str makes of u-blox.
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "drivers/ubx/walk_recording.h"
#include "oracle_programs.h"
#include "rtcm3_streams.h"
#include "support/catch.h"
#include "support/recorded/ephemeris_elements.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

// RINEX holds three decimals; half of the last one, and the rounding of the sum itself.
constexpr double kHalfDigit = 0.0005 + 1e-6;
using test::kMoreFollow;

// The frames with one number, each marked as the last of its epoch: convbin accepts an epoch only
// if all systems agree on its time, which GMSD7's do not.
std::vector<std::uint8_t> alone(const std::vector<std::uint8_t>& bytes, std::uint16_t type) {
  std::vector<std::uint8_t> result;
  for (const auto& extent : test::frame_extents(bytes)) {
    if (extent.type != type) continue;
    const auto frame = std::span(bytes).subspan(extent.first, extent.size);
    test::append(&result, test::edited(frame, {{kMoreFollow, 1, 0}}));
  }
  return result;
}

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

struct Agreement {
  long values = 0, different = 0, lost_in_both = 0, lost_in_neither = 0;
  long lost_after_gap = 0, lost_in_one = 0;
};

void compare(double ours, double theirs, Agreement* agreement, double more = 0.0) {
  if (std::isnan(ours) && std::isnan(theirs)) return;
  ++agreement->values;
  if (!(std::abs(ours - theirs) <= kHalfDigit + more)) ++agreement->different;
}

Agreement compare_observations(const std::vector<std::uint8_t>& bytes, GpsTime reference,
                               const std::string& date) {
  const test::TemporaryFile stream("stream.rtcm3", text_of(bytes));
  REQUIRE(test::run("convbin -r rtcm3 -v 3.04 -os -od -tr " + date + " -o '" +
                    stream.beside("rinex.obs") + "' '" + stream.path() + "' >/dev/null 2>&1"));
  const auto ours = test::decode_rtcm3(bytes, reference);
  ObservationReader reader(stream.beside("rinex.obs"));
  RawEpoch theirs;
  Agreement agreement;
  std::map<std::pair<SatelliteId, SignalCode>, GpsTime> last;
  for (const RawEpoch& epoch : ours.epochs) {
    REQUIRE(reader.next(&theirs));
    REQUIRE(theirs.time == epoch.time);
    REQUIRE(theirs.observations.size() == epoch.observations.size());
    for (std::size_t i = 0; i < theirs.observations.size(); ++i) {
      const SignalObservation &a = epoch.observations[i], &b = theirs.observations[i];
      REQUIRE(a.satellite == b.satellite);
      REQUIRE(a.code == b.code);
      compare(a.pseudorange_m, b.pseudorange_m, &agreement);
      compare(a.carrier_cycles, b.carrier_cycles, &agreement);
      // RTKLIB holds the Doppler in single precision.
      compare(a.doppler_hz, b.doppler_hz, &agreement, std::abs(a.doppler_hz) * 0x1p-24);
      compare(a.cn0_dbhz, b.cn0_dbhz, &agreement);
      if (std::isnan(a.carrier_cycles)) continue;
      GpsTime& before = last[{a.satellite, a.code}];
      const double gap_s = seconds_between(epoch.time, before);
      const bool is_first = !before.is_set();
      before = epoch.time;
      if (is_first) continue;  // a signal's first carrier interrupts nothing
      // RTKLIB compares lock times only; here one younger than the last carrier is a loss too.
      if (a.loss_of_lock && !b.loss_of_lock && a.lock_time_s < gap_s) {
        ++agreement.lost_after_gap;
      } else if (a.loss_of_lock != b.loss_of_lock) {
        ++agreement.lost_in_one;
      }
      if (a.loss_of_lock && b.loss_of_lock) ++agreement.lost_in_both;
      if (!a.loss_of_lock && !b.loss_of_lock) ++agreement.lost_in_neither;
    }
  }
  CHECK_FALSE(reader.next(&theirs));
  return agreement;
}

// Half a unit of the twelfth significant digit, as convbin prints them, and a little more.
double last_digit(double value) {
  if (value == 0.0) return 0.0;
  return 0.5001e-12 * std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1.0);
}

using test::elements_of;

using Key = std::tuple<SatelliteId, NavigationMessage, GpsTime, std::uint16_t>;
Key key_of(const Ephemeris& e) { return {e.satellite, e.message, e.toe, e.issue}; }

// str2str does not end with its input: it is ended once its output has stopped growing.
bool convert_walk(const std::string& output) {
  return test::run("str2str -in 'file://" + test::shared_data(test::kWalkUbx) +
                   "#ubx' -out 'file://" + output +
                   "#rtcm3' -msg 1077,1087,1097,1127,1019,1042 >/dev/null 2>&1 & pid=$!; "
                   "size=0; for i in $(seq 60); do sleep 3; now=$(stat -c %s '" +
                   output +
                   "'); [ \"$now\" -gt 0 ] && [ \"$now\" = \"$size\" ] && break; size=$now; done; "
                   "kill $pid");
}

}  // namespace

TEST_CASE("Observations agree with convbin's in every value") {
  if (!test::have_program("convbin")) return;
  struct Part {
    const char* name;
    std::uint16_t type;
    GpsTime reference;
    const char* date;
    long values;
  };
  const GpsTime then = test::day(2012, 10, 14), later = test::day(2024, 3, 20);
  for (const Part& part : {Part{test::kGmsd7, 1077, then, "2012/10/14 00:00:00", 24660},
                           Part{test::kGmsd7, 1127, then, "2012/10/14 00:00:00", 20662},
                           Part{test::kManyTypes, 1076, later, "2024/03/20 12:00:00", 126},
                           Part{test::kManyTypes, 1077, later, "2024/03/20 12:00:00", 168},
                           Part{test::kManyTypes, 1096, later, "2024/03/20 12:00:00", 105},
                           Part{test::kManyTypes, 1097, later, "2024/03/20 12:00:00", 140},
                           Part{test::kManyTypes, 1126, later, "2024/03/20 12:00:00", 69},
                           Part{test::kManyTypes, 1127, later, "2024/03/20 12:00:00", 92}}) {
    if (!test::have_shared_data(part.name)) continue;
    CAPTURE(part.name, part.type);
    const auto bytes = alone(test::stream_bytes(test::shared_data(part.name)), part.type);
    const Agreement agreement = compare_observations(bytes, part.reference, part.date);
    CHECK(agreement.values == part.values);
    CHECK(agreement.different == 0);
    CHECK(agreement.lost_in_one == 0);
    CHECK(agreement.lost_after_gap <= 10);
    CHECK((agreement.lost_in_neither > 0) == (part.name == test::kGmsd7));
  }
}

TEST_CASE("Ephemerides agree with convbin's to the twelfth digit") {
  if (!test::have_program("convbin")) return;
  struct Part {
    const char* name;
    GpsTime reference;
    const char* date;
    std::size_t least;
  };
  for (const Part& part :
       {Part{test::kGmsd7, test::day(2012, 10, 14), "2012/10/14 00:00:00", 15},
        Part{test::kManyTypes, test::day(2024, 3, 20), "2024/03/20 12:00:00", 4},
        Part{test::kSsrHour, test::day(2023, 8, 17), "2023/08/17 12:00:00", 170}}) {
    if (!test::have_shared_data(part.name)) continue;
    CAPTURE(part.name);
    const auto bytes = test::stream_bytes(test::shared_data(part.name));
    const test::TemporaryFile stream("stream.rtcm3", text_of(bytes));
    REQUIRE(test::run("convbin -r rtcm3 -v 3.04 -tr " + std::string(part.date) + " -n '" +
                      stream.beside("rinex.nav") + "' '" + stream.path() + "' >/dev/null 2>&1"));
    const NavigationFile theirs = read_navigation(stream.beside("rinex.nav"));
    const auto ours = test::decode_rtcm3(bytes, part.reference);
    std::map<Key, Ephemeris> by_key;
    for (const Ephemeris& e : ours.ephemerides) by_key[key_of(e)] = e;
    CHECK(theirs.ephemerides.size() >= part.least);
    CHECK(by_key.size() >= theirs.ephemerides.size());
    for (Ephemeris t : theirs.ephemerides) {
      // For BeiDou convbin puts a number of its own making where the age of data belongs.
      const bool is_beidou = t.satellite.system == System::kBeidou;
      if (is_beidou) {
        for (const Ephemeris& e : ours.ephemerides) {
          if (e.satellite == t.satellite && e.toe == t.toe) t.issue = e.issue;
        }
      }
      CAPTURE(to_string(t.satellite), static_cast<int>(t.message), t.toe.tow_s(), t.issue);
      REQUIRE(by_key.contains(key_of(t)));
      const Ephemeris& o = by_key[key_of(t)];
      CHECK(o.toc == t.toc);
      CHECK(o.health == t.health);
      CHECK(o.accuracy_m == Approx(t.accuracy_m).epsilon(1e-12));
      const auto a = elements_of(o), b = elements_of(t);
      for (std::size_t i = 0; i < a.size(); ++i) {
        CAPTURE(i, a[i], b[i]);
        CHECK(std::abs(a[i] - b[i]) <= last_digit(a[i]));
      }
    }
  }
}

TEST_CASE("A u-blox recording that RTKLIB turned into RTCM 3 gives the same as itself") {
  if (!test::have_program("str2str") || !test::have_shared_data(test::kWalkUbx)) return;
  const test::TemporaryFile stream("walk.rtcm3", "");
  REQUIRE(convert_walk(stream.path()));
  const auto ubx = test::decode_walk();
  const auto ours = test::decode_rtcm3(test::stream_bytes(stream.path()), ubx.epochs[0].time);
  REQUIRE(ours.epochs.size() == 536);
  REQUIRE(ubx.epochs.size() == ours.epochs.size());
  long values = 0, carriers = 0, filled = 0;
  for (std::size_t k = 0; k < ours.epochs.size(); ++k) {
    // str2str rounds the time tag to milliseconds and leaves the ranges as they are.
    REQUIRE(std::abs(seconds_between(ours.epochs[k].time, ubx.epochs[k].time)) <= 0.0005);
    std::map<std::pair<SatelliteId, SignalCode>, SignalObservation> there;
    for (const auto& o : ubx.epochs[k].observations) there[{o.satellite, o.code}] = o;
    for (const auto& o : ours.epochs[k].observations) {
      CAPTURE(k, to_string(o.satellite), to_string(o.code));
      REQUIRE(there.contains({o.satellite, o.code}));
      const SignalObservation& u = there[{o.satellite, o.code}];
      ++values;
      CHECK(std::abs(o.pseudorange_m - u.pseudorange_m) < 0.0003);  // half of 2^-29 ms
      if (std::isfinite(o.doppler_hz)) CHECK(std::abs(o.doppler_hz - u.doppler_hz) < 0.0005);
      CHECK(o.cn0_dbhz == u.cn0_dbhz);
      if (std::isnan(o.carrier_cycles) || std::isnan(u.carrier_cycles)) continue;
      // The message holds the carrier within a kilometre of the code: whole cycles are taken off.
      ++carriers;
      const double off = u.carrier_cycles - o.carrier_cycles;
      // Where its receiver has no carrier that it trusts, str2str writes the cycles last taken off.
      if (std::abs(off - std::round(off)) > 0.0012) ++filled;
    }
  }
  CHECK(values == 11156);
  CHECK(carriers == 7411);
  CHECK(filled == 86);
  // Ephemerides: the same bits through two messages.
  std::map<Key, Ephemeris> by_key;
  for (const Ephemeris& e : ubx.ephemerides) by_key[key_of(e)] = e;
  CHECK(ours.ephemerides.size() > 10);
  for (const Ephemeris& e : ours.ephemerides) {
    CAPTURE(to_string(e.satellite), e.toe.tow_s());
    REQUIRE(by_key.contains(key_of(e)));
    const Ephemeris& u = by_key[key_of(e)];
    CHECK(e.toc == u.toc);
    CHECK(e.issue_clock == u.issue_clock);
    CHECK(e.health == u.health);
    CHECK(e.accuracy_m == u.accuracy_m);
    CHECK(elements_of(e) == elements_of(u));
  }
}

}  // namespace leonav
