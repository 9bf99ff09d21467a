// What the writers write, leonav's own readers read back. That RTKLIB reads it too is
// tools/validate simulation's business.
#include <cmath>

#include "drivers/antex/antex_reader.h"
#include "drivers/clk/clock_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/sim/export/antex_writer.h"
#include "tools/sim/export/clock_writer.h"
#include "tools/sim/export/rinex_navigation_writer.h"
#include "tools/sim/export/rinex_observation_writer.h"
#include "tools/sim/export/sp3_writer.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2136, 345'600.0);
const SatelliteId kG07{System::kGps, 7}, kC59{System::kBeidou, 59}, kL101{System::kLeo, 101};

SignalObservation observation(SatelliteId satellite, SignalCode code, double lock_s) {
  SignalObservation o;
  o.satellite = satellite;
  o.code = code;
  o.pseudorange_m = 21'345'678.9014;
  o.carrier_cycles = -112'345'678.12345;
  o.doppler_hz = -1234.5678;
  o.cn0_dbhz = 43.25;
  o.lock_time_s = lock_s;
  return o;
}

ObservationFileHeader header() {
  ObservationFileHeader h;
  h.antenna = "LEONAV_ZERO     NONE";
  h.signals = {{System::kGps, {{'1', 'C'}, {'2', 'W'}}},
               {System::kBeidou, {{'2', 'I'}, {'6', 'I'}}},
               {System::kLeo, {{'1', 'C'}, {'2', 'W'}}}};
  return h;
}

}  // namespace

TEST_CASE("Observations come back with the digits of RINEX") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("run.obs");
  RinexObservationWriter writer(path, header());
  RawEpoch epoch;
  for (int i = 0; i < 4; ++i) {
    epoch.time = kStart.plus_seconds(59.5 + i);  // seconds carry into minutes
    epoch.observations.clear();
    // Lock a little shorter than the interval: by another clock. The third was really interrupted.
    const double lock_s = i == 2 ? 0.3 : i * 0.99999;
    SignalObservation first = observation(kG07, {'1', 'C'}, lock_s);
    first.half_cycle_ambiguous = i == 1;
    epoch.observations.push_back(first);
    SignalObservation without = observation(kG07, {'2', 'W'}, i);
    without.carrier_cycles = without.doppler_hz = kNotMeasured;
    epoch.observations.push_back(without);
    epoch.observations.push_back(observation(kC59, {'6', 'I'}, i));
    epoch.observations.push_back(observation(kL101, {'1', 'C'}, i));
    epoch.observations.push_back(observation(kL101, {'5', 'Q'}, i));  // not in the header
    writer.write(epoch);
  }
  writer.close();
  CHECK(writer.left_out() == 4);

  ObservationReader reader(path);
  CHECK(reader.header().antenna == "LEONAV_ZERO     NONE");
  RawEpoch back;
  for (int i = 0; i < 4; ++i) {
    REQUIRE(reader.next(&back));
    CHECK(back.time == kStart.plus_seconds(59.5 + i));
    REQUIRE(back.observations.size() == 4);
    const SignalObservation& first = back.observations[0];
    CHECK(first.satellite == kG07);
    CHECK(first.pseudorange_m == Approx(21'345'678.901).epsilon(1e-15));
    CHECK(first.carrier_cycles == Approx(-112'345'678.123).epsilon(1e-15));
    CHECK(first.doppler_hz == Approx(-1234.568).epsilon(1e-12));
    CHECK(first.cn0_dbhz == Approx(43.25));
    CHECK(first.loss_of_lock == (i == 2));
    CHECK(first.half_cycle_ambiguous == (i == 1));
    CHECK(std::isnan(back.observations[1].carrier_cycles));
    CHECK(back.observations[1].pseudorange_m == Approx(21'345'678.901).epsilon(1e-15));
    CHECK(back.observations[2].satellite == kC59);
    CHECK(back.observations[2].code == SignalCode{'6', 'I'});
    CHECK(back.observations[3].satellite == kL101);
  }
  CHECK_FALSE(reader.next(&back));
  CHECK(reader.counts().skipped_total() == 0);
}

TEST_CASE("Orbits come back to the millimetre and the picosecond, with their flags") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("run.sp3");
  std::vector<OrbitEpoch> epochs;
  for (int i = 0; i < 3; ++i) {
    OrbitEpoch epoch{kStart.plus_seconds(30.0 * i), {}};
    for (int number = 1; number <= 150; ++number) {
      PreciseState state{{System::kLeo, static_cast<std::uint16_t>(number)},
                         epoch.time,
                         {7'000'123.4567, -1'234'567.8912, 42.0 + number},
                         1.234567890123e-4};
      state.clock_event = i == 1 && number == 3;
      state.orbit_predicted = state.clock_predicted = i == 2;
      state.maneuver = number == 150;
      if (number == 9) state.clock_s = std::nan("");
      epoch.states.push_back(state);
    }
    epochs.push_back(epoch);
  }
  write_sp3(path, epochs, "A comment.");
  const Sp3File file = read_sp3(path);
  CHECK(file.version == 'd');
  CHECK(file.time_system == "GPS");
  CHECK(file.satellites_listed == 150);
  CHECK(file.damaged_lines == 0);
  CHECK_FALSE(file.truncated);
  CHECK(file.bad_clocks == 3);
  CHECK(file.clock_events == 1);
  CHECK(file.maneuvers == 3);
  CHECK(file.predicted == 150);
  REQUIRE(file.epochs.size() == 3);
  CHECK(file.epochs[2].time == kStart.plus_seconds(60.0));
  REQUIRE(file.epochs[1].states.size() == 150);
  const PreciseState& state = file.epochs[1].states[2];
  CHECK((state.p_e - epochs[1].states[2].p_e).cwiseAbs().maxCoeff() < 0.501e-3);
  CHECK(std::abs(state.clock_s - 1.234567890123e-4) < 0.501e-12);
  CHECK(state.clock_event);
}

TEST_CASE("Clocks come back with thirteen digits") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("run.clk");
  std::vector<OrbitEpoch> epochs;
  for (int i = 0; i < 2; ++i) {
    const GpsTime time = kStart.plus_seconds(30.0 * i);
    PreciseState a{kG07, time, {}, -9.87654321012345e-5}, b{kL101, time, {}, 1e-9};
    a.p_e.setConstant(std::nan(""));
    b.p_e = a.p_e;
    epochs.push_back({time, {a, b}});
  }
  epochs[1].states[1].clock_s = std::nan("");
  write_rinex_clock(path, epochs);
  ClockReader reader(path);
  ClockEpoch epoch;
  REQUIRE(reader.next(&epoch));
  REQUIRE(epoch.states.size() == 2);
  CHECK(epoch.states[0].clock_s == Approx(-9.87654321012345e-5).epsilon(1e-12));
  CHECK(epoch.states[1].satellite == kL101);
  REQUIRE(reader.next(&epoch));
  CHECK(epoch.time == kStart.plus_seconds(30.0));
  CHECK(epoch.states.size() == 1);
  CHECK_FALSE(reader.next(&epoch));
  CHECK(reader.counts().damaged_lines == 0);
}

TEST_CASE("Antennas come back, those without a pattern as zeros") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("antennas.atx");
  AntennaPattern receiver;
  receiver.is_receiver = true;
  receiver.satellite = {System::kGps, 0};
  receiver.band = '1';
  AntennaPattern satellite;
  satellite.satellite = kL101;
  satellite.band = '2';
  satellite.offset_m = {0.1, -0.2, 1.2345};
  satellite.variation = {0.0, 10.0 * 3.14159265358979 / 180.0, 3, 1, {0.001F, -0.002F, 0.003F}};
  const std::vector<AntennaPattern> patterns = {receiver, satellite};
  write_antex(path, patterns, "LEONAV_ZERO     NONE");
  const AntexFile file = read_antex(path, {kStart, "LEONAV_ZERO     NONE"});
  CHECK(file.damaged == 0);
  REQUIRE(file.receiver.size() == 1);
  CHECK(file.match == ReceiverMatch::kExact);
  CHECK(file.receiver[0].offset_m.isZero());
  for (const float value : file.receiver[0].variation.values) CHECK(value == 0.0F);
  REQUIRE(file.satellites.size() == 1);
  CHECK(file.satellites[0].satellite == kL101);
  CHECK((file.satellites[0].offset_m - satellite.offset_m).cwiseAbs().maxCoeff() < 1e-5);
  REQUIRE(file.satellites[0].variation.values.size() == 3);
  CHECK(file.satellites[0].variation.values[1] == Approx(-0.002F));
}

TEST_CASE("Broadcast elements come back with thirteen digits and each system's own times") {
  const test::TemporaryFile place("unused", "");
  const std::string path = place.beside("run.nav");
  std::vector<Ephemeris> sent;
  // A quarter of a minute into the week: BeiDou's time of week is in the week before.
  const GpsTime week = GpsTime::from_week_and_tow(2137, 0.0);
  for (const auto& [satellite, message] :
       {std::pair{kG07, NavigationMessage::kGpsLnav},
        {SatelliteId{System::kGalileo, 11}, NavigationMessage::kGalileoInav},
        {SatelliteId{System::kGalileo, 11}, NavigationMessage::kGalileoFnav},
        {kC59, NavigationMessage::kBeidouD2},
        {SatelliteId{System::kBeidou, 30}, NavigationMessage::kBeidouD1}}) {
    Ephemeris e;
    e.satellite = satellite;
    e.message = message;
    e.toe = e.toc = week;
    e.transmission_time = week.plus_seconds(-7200.0);
    e.issue = 64, e.health = 1, e.accuracy_m = 2.0;
    e.issue_clock = satellite.system == System::kGalileo ? 0 : 5;
    e.sqrt_a = satellite.system == System::kBeidou ? 6493.4567890123 : 5153.7012345678;
    e.eccentricity = 0.0123456789012, e.m0 = -2.3456789012345, e.delta_n = 4.5e-9;
    e.omega0 = 3.0123456789, e.omega_dot = -8.1e-9, e.i0 = 0.96, e.i_dot = 1.2e-10;
    e.omega = -1.5, e.cuc = 1e-6, e.cus = 2e-6, e.crc = 200.5, e.crs = -30.25;
    e.cic = -1e-7, e.cis = 2e-7, e.af0 = -1.2345e-4, e.af1 = 3e-12;
    e.group_delay_s = {-1.1e-8, satellite.system == System::kGps ? 0.0 : 2.2e-8};
    sent.push_back(e);
  }
  write_rinex_navigation(path, sent);
  const NavigationFile file = read_navigation(path);
  CHECK(file.counts.skipped_total() == 0);
  REQUIRE(file.ephemerides.size() == sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const Ephemeris &a = sent[i], &b = file.ephemerides[i];
    CHECK(b.satellite == a.satellite);
    CHECK(b.message == a.message);
    CHECK(b.toe == a.toe);
    CHECK(b.toc == a.toc);
    CHECK(b.transmission_time == a.transmission_time);
    CHECK(b.issue == a.issue);
    CHECK(b.issue_clock == a.issue_clock);
    CHECK(b.health == a.health);
    CHECK(b.sqrt_a == Approx(a.sqrt_a).epsilon(1e-12));
    CHECK(b.m0 == Approx(a.m0).epsilon(1e-12));
    CHECK(b.crs == Approx(a.crs).epsilon(1e-12));
    CHECK(b.af0 == Approx(a.af0).epsilon(1e-12));
    CHECK(b.group_delay_s[0] == Approx(a.group_delay_s[0]));
    CHECK(b.group_delay_s[1] == Approx(a.group_delay_s[1]));
  }
}

TEST_CASE("A file that cannot be written is an error that names it") {
  CHECK_THROWS_WITH(write_rinex_navigation("/nowhere/run.nav", {}),
                    Catch::Contains("/nowhere/run.nav"));
}
