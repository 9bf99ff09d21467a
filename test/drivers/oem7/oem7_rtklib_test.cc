// The recording of an OEM-V receiver through RTKLIB: convbin's RINEX of it.
#include <cmath>
#include <map>

#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "oem7_streams.h"
#include "oracle_programs.h"
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

}  // namespace

TEST_CASE("A recorded RANGECMP agrees with convbin's RINEX in every value") {
  if (!test::have_program("convbin") || !test::have_shared_data(test::kOemv)) return;
  const std::string path = test::shared_data(test::kOemv);
  const test::TemporaryFile place("stream.gps", "");
  REQUIRE(test::run("convbin -r nov -v 3.04 -os -od -o '" + place.beside("rinex.obs") + "' '" +
                    path + "' >/dev/null 2>&1"));
  const auto ours = test::decode_oem7(test::stream_bytes(path));
  ObservationReader reader(place.beside("rinex.obs"));
  RawEpoch theirs;
  long values = 0, different = 0, only_ours = 0, lost = 0, lost_in_one = 0, ambiguous = 0;
  const auto compare = [&](double a, double b, double more) {
    if (std::isnan(a) && std::isnan(b)) return;
    ++values;
    if (!(std::abs(a - b) <= kHalfDigit + more)) ++different;
  };
  for (const RawEpoch& epoch : ours.epochs) {
    REQUIRE(reader.next(&theirs));
    REQUIRE(theirs.time == epoch.time);
    std::map<std::pair<SatelliteId, SignalCode>, SignalObservation> there;
    for (const auto& o : theirs.observations) there[{o.satellite, o.code}] = o;
    for (const SignalObservation& o : epoch.observations) {
      const auto found = there.find({o.satellite, o.code});
      CAPTURE(epoch.time.tow_s(), to_string(o.satellite), to_string(o.code));
      if (found == there.end()) {
        ++only_ours;
        continue;
      }
      compare(o.pseudorange_m, found->second.pseudorange_m, 0.0);
      compare(o.carrier_cycles, found->second.carrier_cycles, 0.0);
      compare(o.cn0_dbhz, found->second.cn0_dbhz, 0.0);
      // RTKLIB holds the Doppler in single precision, and leaves it out where the phase is not
      // locked.
      if (std::isfinite(found->second.doppler_hz)) {
        compare(o.doppler_hz, found->second.doppler_hz, std::abs(o.doppler_hz) * 0x1p-24);
      }
      if (std::isnan(o.carrier_cycles)) continue;
      // RTKLIB counts some of the first carriers as lost; they interrupt nothing.
      if (&epoch != &ours.epochs.front()) {
        lost += o.loss_of_lock;
        lost_in_one += o.loss_of_lock != found->second.loss_of_lock;
      }
      ambiguous += o.half_cycle_ambiguous != found->second.half_cycle_ambiguous;
      there.erase(found);
    }
    CHECK(there.empty());
  }
  CHECK_FALSE(reader.next(&theirs));
  CHECK(ours.epochs.size() == 46);
  CHECK(values > 3000);
  CHECK(different == 0);
  CHECK(only_ours == 0);
  CAPTURE(lost);
  CHECK(lost_in_one == 0);
  CHECK(ambiguous == 0);
}

TEST_CASE("Recorded RAWEPHEM agree with convbin's to the twelfth digit") {
  if (!test::have_program("convbin") || !test::have_shared_data(test::kOemv)) return;
  const std::string path = test::shared_data(test::kOemv);
  const test::TemporaryFile place("stream.gps", "");
  REQUIRE(test::run("convbin -r nov -v 3.04 -n '" + place.beside("rinex.nav") + "' '" + path +
                    "' >/dev/null 2>&1"));
  const NavigationFile theirs = read_navigation(place.beside("rinex.nav"));
  const auto ours = test::decode_oem7(test::stream_bytes(path));
  std::map<SatelliteId, Ephemeris> by_satellite;
  for (const Ephemeris& e : ours.ephemerides) by_satellite[e.satellite] = e;
  CHECK(theirs.ephemerides.size() == by_satellite.size());
  CHECK(theirs.ephemerides.size() > 5);
  for (const Ephemeris& t : theirs.ephemerides) {
    CAPTURE(to_string(t.satellite));
    REQUIRE(by_satellite.contains(t.satellite));
    const Ephemeris& o = by_satellite[t.satellite];
    CHECK(o.toe == t.toe);
    CHECK(o.toc == t.toc);
    CHECK(o.issue == t.issue);
    CHECK(o.issue_clock == t.issue_clock);
    CHECK(o.health == t.health);
    CHECK(o.accuracy_m == Approx(t.accuracy_m).epsilon(1e-12));
    const auto a = test::elements_of(o), b = test::elements_of(t);
    for (std::size_t i = 0; i < a.size(); ++i) {
      CAPTURE(i, a[i], b[i]);
      CHECK(std::abs(a[i] - b[i]) <= last_digit(a[i]));
    }
  }
}

}  // namespace leonav
