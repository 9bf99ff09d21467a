// Blocks packed here by the guide's tables, and recorded ones: what becomes of them, and of those
// that cannot be used.
#include <cmath>
#include <numbers>

#include "core/gnss/signals/signal.h"
#include "drivers/sbf/sbf_signal.h"
#include "sbf_streams.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::block_of;
using test::Bytes;
using test::decode_sbf;
using test::epoch_block;
using test::Master;
using test::meas_epoch_of;
using test::Slave;

void join(std::vector<std::uint8_t>* stream, const std::vector<std::uint8_t>& more) {
  stream->insert(stream->end(), more.begin(), more.end());
}

const SignalObservation& find(const RawEpoch& epoch, SatelliteId satellite, const char* code) {
  for (const SignalObservation& o : epoch.observations) {
    if (o.satellite == satellite && to_string(o.code) == code) return o;
  }
  FAIL("no " << to_string(satellite) << " " << code);
  return epoch.observations.front();
}

// GPSNav of G07 with two issue numbers; everything else as a satellite sends it.
std::vector<std::uint8_t> gpsnav(unsigned issue2, unsigned issue3, unsigned week = 2367 % 1024,
                                 std::uint32_t toe = 482'400) {
  Bytes b;
  b.u1(7).u1(0).u2(week).u1(1).u1(0).u1(0).u1(0).u2(0x100 | issue2).u1(issue2).u1(issue3);
  b.u1(0).u1(0).r4(-1e-8F).u4(482'400).r4(0).r4(1e-12F).r4(1e-4F).r4(10).r4(1.5e-9F).r8(0.5);
  b.r4(1e-6F).r8(0.01).r4(1e-6F).r8(5153.6).u4(toe).r4(1e-8F).r8(0.25).r4(1e-8F).r8(0.305);
  b.r4(200).r8(-0.25).r4(-2.5e-9F).r4(1e-10F).u2(2367 % 1024).u2(2367 % 1024);
  return b.list;
}

struct Sensor {
  unsigned source = 0x20, type = 0;
  double x = 0, y = 0, z = 0;
};
std::vector<std::uint8_t> ext_sensor(const std::vector<Sensor>& sensors, unsigned size = 28) {
  Bytes b;
  b.u1(sensors.size()).u1(size);
  for (const Sensor& s : sensors) {
    b.u1(s.source).u1(1).u1(s.type).u1(0).r8(s.x).r8(s.y).r8(s.z);
    for (unsigned i = 28; i < size; ++i) b.u1(0x99);
  }
  return b.list;
}

}  // namespace

TEST_CASE("A MeasEpoch is an epoch with its last byte, slaves relative to their master") {
  Slave slave;
  slave.code_high = -1;
  slave.doppler_high = -2;
  slave.carrier_high = 3;
  const auto block = epoch_block({{.slaves = {slave}}});
  test::SbfCollector collector;
  SbfDecoder decoder;
  decoder.feed(std::span(block).first(block.size() - 1), &collector);
  CHECK(collector.epochs.empty());
  decoder.feed(std::span(block).last(1), &collector);
  REQUIRE(collector.epochs.size() == 1);
  const RawEpoch& epoch = collector.epochs[0];
  CHECK(epoch.time == test::time_at(test::kTime_ms));
  REQUIRE(epoch.observations.size() == 2);
  const SatelliteId satellite{System::kGps, 5};
  const SignalObservation& m = find(epoch, satellite, "1C");
  CHECK(m.pseudorange_m == Approx(21'761'200.335).epsilon(1e-15));
  CHECK(m.carrier_cycles ==
        Approx(21'761'200.335 * 1575.42e6 / 299'792'458.0 + 0.007).epsilon(1e-15));
  CHECK(m.doppler_hz == Approx(1121.758).epsilon(1e-15));
  CHECK(m.cn0_dbhz == 50.0);
  CHECK(m.lock_time_s == 876.0);
  CHECK_FALSE(m.half_cycle_ambiguous);
  CHECK_FALSE(m.loss_of_lock);
  const SignalObservation& s = find(epoch, satellite, "2W");
  const double slave_m = 21'761'200.335 - 65.536 + 0.5;
  CHECK(s.pseudorange_m == Approx(slave_m).epsilon(1e-15));
  CHECK(s.carrier_cycles ==
        Approx(slave_m * 1227.6e6 / 299'792'458.0 + 3 * 65.536 + 1.0).epsilon(1e-15));
  CHECK(s.doppler_hz == Approx(1121.758 * 60.0 / 77.0 - 2 * 6.5536 + 0.01).epsilon(1e-14));
  CHECK(s.cn0_dbhz == 35.0);  // no offset of P(Y)
  CHECK(s.lock_time_s == 254.0);
}

TEST_CASE("Values that are marked as not available are not measured, nor what depends on them") {
  Slave no_code, no_carrier, no_doppler, no_strength;
  no_code.code_high = -4;
  no_code.code_low = 0;
  no_carrier.type = 3;
  no_carrier.carrier_high = -128;
  no_carrier.carrier_low = 0;
  no_doppler.type = 4;
  no_doppler.doppler_high = -16;
  no_doppler.doppler_low = 0;
  no_strength.type = 5;
  no_strength.cn0 = 255;
  no_strength.lock_s = 255;
  Master whole{.slaves = {no_code, no_carrier, no_doppler, no_strength}};
  Master without_code{.satellite = 6, .code_mm = 0, .slaves = {Slave{}}};
  Master without_doppler{.satellite = 7, .doppler = -2'147'483'648, .slaves = {Slave{}}};
  Master without_carrier{.satellite = 8, .carrier_low = 0, .carrier_high = 0x80};
  const auto decoded =
      decode_sbf(epoch_block({whole, without_code, without_doppler, without_carrier}));
  REQUIRE(decoded.epochs.size() == 1);
  const auto observed = [&](std::uint16_t number, const char* code) {
    return find(decoded.epochs[0], {System::kGps, number}, code);
  };
  CHECK(std::isnan(observed(5, "2W").pseudorange_m));
  CHECK(std::isnan(observed(5, "2W").carrier_cycles));
  CHECK(std::isfinite(observed(5, "2W").doppler_hz));
  CHECK(std::isnan(observed(5, "2L").carrier_cycles));
  CHECK(std::isfinite(observed(5, "2L").pseudorange_m));
  CHECK(std::isnan(observed(5, "5Q").doppler_hz));
  CHECK(std::isfinite(observed(5, "5Q").carrier_cycles));
  CHECK(std::isnan(observed(5, "1L").cn0_dbhz));
  CHECK(std::isnan(observed(5, "1L").lock_time_s));
  CHECK(observed(5, "1L").loss_of_lock);  // nothing says that it is locked
  for (const char* code : {"1C", "2W"}) {
    CHECK(std::isnan(observed(6, code).pseudorange_m));
    CHECK(std::isnan(observed(6, code).carrier_cycles));
    CHECK(std::isfinite(observed(6, code).doppler_hz));
    CHECK(std::isnan(observed(7, code).doppler_hz));
    CHECK(std::isfinite(observed(7, code).carrier_cycles));
  }
  CHECK(std::isnan(observed(8, "1C").carrier_cycles));
  CHECK(decoded.counters.epochs.bad_value == 0);
}

// The guide's table of satellites and signals.
TEST_CASE("Satellites and signals have the guide's numbers") {
  CHECK_FALSE(satellite_from_sbf(0));
  CHECK(satellite_from_sbf(1) == SatelliteId{System::kGps, 1});
  CHECK(satellite_from_sbf(37) == SatelliteId{System::kGps, 37});
  for (const int other : {38, 61, 62, 68, 70, 107, 119, 120, 140, 181, 190, 197, 215, 222, 246}) {
    CHECK_FALSE(satellite_from_sbf(static_cast<std::uint8_t>(other)));
  }
  CHECK(satellite_from_sbf(71) == SatelliteId{System::kGalileo, 1});
  CHECK(satellite_from_sbf(106) == SatelliteId{System::kGalileo, 36});
  CHECK(satellite_from_sbf(141) == SatelliteId{System::kBeidou, 1});
  CHECK(satellite_from_sbf(180) == SatelliteId{System::kBeidou, 40});
  CHECK(satellite_from_sbf(223) == SatelliteId{System::kBeidou, 41});
  CHECK(satellite_from_sbf(245) == SatelliteId{System::kBeidou, 63});

  const char* codes[] = {"G1C", "G1W", "G2W", "G2L", "G5Q", "G1L", "", "",    "",    "",
                         "",    "",    "",    "C1P", "C5P", "",    "", "E1C", "",    "E6C",
                         "E5Q", "E7Q", "E8Q", "",    "",    "",    "", "",    "C2I", "C7I",
                         "C6I", "",    "",    "",    "C7D", "",    "", "",    "",    ""};
  for (std::uint32_t number = 0; number < std::size(codes); ++number) {
    const auto signal = signal_from_sbf(number, false);
    const std::string name =
        signal ? to_string(SatelliteId{signal->system, 1}).substr(0, 1) + to_string(signal->code)
               : "";
    CHECK(name == codes[number]);
  }
  CHECK(to_string(signal_from_sbf(19, true)->code) == "6B");
  CHECK(sbf_signal_number(30, 7) == 30);
  CHECK(sbf_signal_number(31, 2) == 34);
}

TEST_CASE("Signal numbers from 32 on are in the extension, and E6 tells its component") {
  Master b2b{.type = 31, .satellite = 160, .info = 2u << 3};
  Master e6{.type = 19, .satellite = 80};
  const auto decoded = decode_sbf(block_of({4027}, meas_epoch_of({b2b, e6}, 1u << 6)));
  REQUIRE(decoded.epochs.size() == 1);
  const SignalObservation& o = find(decoded.epochs[0], {System::kBeidou, 20}, "7D");
  CHECK(o.carrier_cycles ==
        Approx(o.pseudorange_m * 1207.14e6 / 299'792'458.0 + 0.007).epsilon(1e-15));
  find(decoded.epochs[0], {System::kGalileo, 10}, "6B");
}

TEST_CASE("What cannot be used of an epoch is counted by its reason") {
  Master glonass{.type = 8, .satellite = 45}, reserved{.type = 16}, foreign{.type = 17};
  Master near{.satellite = 9, .code_mm = 900'000'000}, twice{.satellite = 10};
  Master second{.type = 1u << 5, .satellite = 11};
  Slave of_third{.type = 2u << 5 | 2};
  Master main{.satellite = 12, .slaves = {of_third}};
  Master nothing{.satellite = 13, .code_mm = 0, .doppler = -2'147'483'648};
  const auto decoded = decode_sbf(
      epoch_block({glonass, reserved, foreign, near, twice, twice, second, main, nothing}));
  REQUIRE(decoded.epochs.size() == 1);
  const SbfCounters& c = decoded.counters;
  CHECK(c.epochs.other_system == 1);
  CHECK(c.epochs.unknown_signal == 2);
  CHECK(c.epochs.bad_value == 1);  // a range of 900 km
  CHECK(c.epochs.duplicates == 1);
  CHECK(c.epochs.empty == 1);
  CHECK(c.epochs.measurements == 3);
  CHECK(c.measurements.other_antennas == 2);
}

TEST_CASE("Longer sub-blocks of a later revision are read, shorter and missing ones refused") {
  const auto payload = meas_epoch_of({{.slaves = {Slave{}}}});
  // The master ends at 26, the slave at 38; four bytes more of each.
  Bytes longer;
  longer.join(std::span(payload).first(26)).u4(0xFFFFFFFF);
  longer.join(std::span(payload).subspan(26)).u4(0xFFFFFFFF);
  longer.list[1] = 24;
  longer.list[2] = 16;
  const auto decoded = decode_sbf(block_of({4027, test::kTime_ms, test::kWeek, 5}, longer.list));
  REQUIRE(decoded.epochs.size() == 1);
  CHECK(test::same_epoch(decoded.epochs[0], decode_sbf(block_of({4027}, payload)).epochs[0]));
  for (const auto& [index, value] : {std::pair{1, 19}, {2, 11}, {0, 2}, {1, 40}, {25, 3}}) {
    auto wrong = payload;
    wrong[static_cast<std::size_t>(index)] = static_cast<std::uint8_t>(value);
    const auto refused = decode_sbf(block_of({4027}, wrong));
    CAPTURE(index, value);
    CHECK(refused.epochs.empty());
    CHECK(refused.counters.measurements.bad_length == 1);
  }
  CHECK(decode_sbf(block_of({4027}, {})).counters.measurements.bad_length == 1);
  // No satellite is an epoch too.
  CHECK(decode_sbf(block_of({4027}, meas_epoch_of({}))).epochs.size() == 1);
}

TEST_CASE("Epochs without time, scrambled, and twice are counted and give nothing") {
  const auto payload = meas_epoch_of({{}});
  std::vector<std::uint8_t> stream;
  join(&stream, block_of({4027, 0xFFFFFFFF}, payload));
  join(&stream, block_of({4027, test::kTime_ms, 0xFFFF}, payload));
  join(&stream, block_of({4027, 604'800'000}, payload));
  join(&stream, block_of({4027, test::kTime_ms, 0}, payload));
  join(&stream, block_of({4027}, meas_epoch_of({{}}, 1u << 7)));
  CHECK(decode_sbf(stream).epochs.empty());
  join(&stream, block_of({4027}, payload));
  join(&stream, block_of({4027}, payload));
  const auto decoded = decode_sbf(stream);
  CHECK(decoded.epochs.size() == 1);
  CHECK(decoded.counters.measurements.without_time == 4);
  CHECK(decoded.counters.measurements.scrambled == 1);
  CHECK(decoded.counters.epochs.repeated == 1);
  CHECK(decoded.counters.framer.blocks == 7);
}

TEST_CASE("A carrier whose lock is younger than its last epoch is told as lost") {
  struct Step {
    std::uint32_t after_ms;
    unsigned lock_s;
    bool is_lost;
  };
  std::vector<std::uint8_t> stream;
  std::uint32_t now = test::kTime_ms;
  // Whole seconds, cut off: in its first second a lock cannot be told from one begun anew.
  const Step steps[] = {{0, 100, false},      {1000, 101, false},        {100, 101, false},
                        {900, 102, false},    {1000, 0, true},           {100, 0, true},
                        {900, 1, false},      {5000, 4, true},           {5000, 9, false},
                        {9000, 9, true},      {1000, 9, false},          {1000, 8, true},
                        {1000, 65534, false}, {70'000'000, 65534, true}, {1000, 65535, true}};
  for (const Step& step : steps) {
    now += step.after_ms;
    join(&stream, epoch_block({{.lock_s = step.lock_s}}, now));
  }
  const auto decoded = decode_sbf(stream);
  REQUIRE(decoded.epochs.size() == std::size(steps));
  for (std::size_t i = 0; i < std::size(steps); ++i) {
    CAPTURE(i);
    CHECK(decoded.epochs[i].observations.at(0).loss_of_lock == steps[i].is_lost);
  }
}

TEST_CASE("A half cycle is ambiguous where the receiver says so") {
  const auto decoded = decode_sbf(epoch_block({{.info = 4}, {.satellite = 6, .info = 3}}));
  REQUIRE(decoded.epochs.size() == 1);
  CHECK(find(decoded.epochs[0], {System::kGps, 5}, "1C").half_cycle_ambiguous);
  CHECK_FALSE(find(decoded.epochs[0], {System::kGps, 6}, "1C").half_cycle_ambiguous);
}

// One block of each kind. The pages are no part of an ephemeris but for a subframe of GPS, and
// their parities, CRCs and check bits hold.
TEST_CASE("Recorded raw navigation bits pass every check of their messages") {
  if (!test::have_shared_data(test::kX5Navigation)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kX5Navigation));
  const auto decoded = decode_sbf(bytes);
  const NavigationCounters& c = decoded.counters.navigation;
  CHECK(decoded.counters.framer.blocks == 8);
  CHECK(c.bad_parity + c.bad_week + c.wrong_satellite == 0);
  CHECK(c.subframes + c.other_message == 5);
  CHECK(decoded.counters.unused.size() == 3);
  // With any bit of a message flipped the checks fail: they are of these bits.
  for (const auto& extent : test::block_extents(bytes)) {
    auto block = std::vector<std::uint8_t>(
        bytes.begin() + static_cast<std::ptrdiff_t>(extent.first),
        bytes.begin() + static_cast<std::ptrdiff_t>(extent.first + extent.size));
    const unsigned number = (block[4] + 256u * block[5]) & 0x1FFF;
    if (number != 4017 && number != 4018 && number != 4022 && number != 4023 && number != 4047)
      continue;
    for (std::size_t i = 20; i < 48; ++i) {
      if (number == 4047 && i == 22) continue;  // reserved bits, which no check covers
      auto wrong = block;
      wrong[i] ^= 0x10;
      const std::uint16_t crc = test::checksum_of(std::span(wrong).subspan(4));
      wrong[2] = static_cast<std::uint8_t>(crc);
      wrong[3] = static_cast<std::uint8_t>(crc >> 8);
      CAPTURE(number, i);
      CHECK(decode_sbf(wrong).counters.navigation.bad_parity == 1);
    }
  }
}

TEST_CASE("Raw navigation blocks that cannot be used are counted by their reason") {
  const auto raw = [](unsigned satellite, unsigned passed, std::uint32_t time = test::kTime_ms) {
    Bytes b;
    b.u1(satellite).u1(passed).u1(0).u1(0).u1(0).u1(1);
    for (int i = 0; i < 10; ++i) b.u4(0);
    return block_of({4017, time}, b.list);
  };
  std::vector<std::uint8_t> stream;
  join(&stream, block_of({4017}, {}));
  join(&stream, raw(71, 1));  // a satellite of Galileo
  join(&stream, raw(0, 1));
  join(&stream, raw(5, 1, 0xFFFFFFFF));
  join(&stream, raw(5, 0));
  join(&stream, raw(5, 1));
  const SbfCounters c = decode_sbf(stream).counters;
  CHECK(c.raw.bad_length == 1);
  CHECK(c.raw.bad_satellite == 2);
  CHECK(c.raw.without_time == 1);
  CHECK(c.raw.crc_failed == 1);
  CHECK(c.navigation.bad_parity == 1);
}

TEST_CASE("Decoded sets that contradict themselves or the time are counted by their reason") {
  std::vector<std::uint8_t> stream;
  join(&stream, block_of({5891}, gpsnav(33, 33)));
  join(&stream, block_of({5891, test::kTime_ms + 1000}, gpsnav(33, 33)));  // the same once more
  join(&stream, block_of({5891}, gpsnav(33, 34)));
  join(&stream, block_of({5891}, gpsnav(34, 34, 2300 % 1024)));
  join(&stream, block_of({5891}, gpsnav(35, 35, 2367 % 1024, 604'800)));
  join(&stream, block_of({5891, 0xFFFFFFFF}, gpsnav(36, 36)));
  auto impossible = gpsnav(37, 37);
  impossible[0] = 90;
  join(&stream, block_of({5891}, impossible));
  join(&stream, block_of({5891}, std::span(impossible).first(100)));
  join(&stream, block_of({4002}, std::vector<std::uint8_t>(140)));
  join(&stream, block_of({5893}, std::vector<std::uint8_t>(20)));
  const auto decoded = decode_sbf(stream);
  REQUIRE(decoded.ephemerides.size() == 1);
  const Ephemeris& e = decoded.ephemerides[0];
  CHECK(e.satellite == SatelliteId{System::kGps, 7});
  CHECK(e.issue == 33);
  CHECK(e.issue_clock == 0x121);
  CHECK(e.m0 == 0.5 * std::numbers::pi);
  CHECK(e.toe == GpsTime::from_week_and_tow(2367, 482'400.0));
  const DecodedNavigationCounters& c = decoded.counters.decoded;
  CHECK(c.bad_subframes == 1);
  CHECK(c.bad_week == 1);
  CHECK(c.bad_time == 1);
  CHECK(c.without_time == 1);
  CHECK(c.bad_satellite == 2);
  CHECK(c.bad_length == 1);
  CHECK(c.bad_ionosphere == 1);
}

TEST_CASE("Angular rates and accelerations of one instant and sensor are a sample") {
  const Sensor acceleration{.type = 0, .x = 0.1, .y = -0.2, .z = -9.8};
  const Sensor rate{.type = 1, .x = 1.0, .y = -2.0, .z = 180.0};
  const Sensor temperature{.type = 3, .x = 1.0};
  for (const unsigned size : {28u, 32u}) {
    const auto decoded =
        decode_sbf(block_of({4050}, ext_sensor({temperature, rate, acceleration}, size)));
    REQUIRE(decoded.rates.size() == 1);
    const ExtSensorRates& r = decoded.rates[0];
    CHECK(r.time == test::time_at(test::kTime_ms));
    CHECK(r.specific_force_m_s2 == ExtSensorRates::Vector{0.1, -0.2, -9.8});
    CHECK(r.angular_rate_rad_s[0] == Approx(std::numbers::pi / 180.0).epsilon(1e-15));
    CHECK(r.angular_rate_rad_s[1] == Approx(-std::numbers::pi / 90.0).epsilon(1e-15));
    CHECK(r.angular_rate_rad_s[2] == Approx(std::numbers::pi).epsilon(1e-15));
  }
  Sensor unknown = rate, infinite = acceleration, elsewhere = rate;
  unknown.y = -2e10;
  infinite.z = INFINITY;
  elsewhere.source = 0x40;
  std::vector<std::uint8_t> stream;
  join(&stream, block_of({4050}, ext_sensor({acceleration, unknown})));
  join(&stream, block_of({4050}, ext_sensor({infinite, rate})));
  join(&stream, block_of({4050}, ext_sensor({acceleration, elsewhere})));
  join(&stream, block_of({4050}, ext_sensor({acceleration, temperature})));
  join(&stream, block_of({4050}, ext_sensor({})));
  join(&stream, block_of({4050, 0xFFFFFFFF}, ext_sensor({acceleration, rate})));
  auto more = ext_sensor({acceleration, rate});
  more[0] = 9;
  join(&stream, block_of({4050}, more));
  auto shorter = ext_sensor({acceleration, rate});
  shorter[1] = 27;
  join(&stream, block_of({4050}, shorter));
  const auto decoded = decode_sbf(stream);
  CHECK(decoded.rates.empty());
  const ExtSensorCounters& c = decoded.counters.imu;
  CHECK(c.bad_value == 2);
  CHECK(c.without_motion == 3);
  CHECK(c.without_time == 1);
  CHECK(c.bad_length == 2);
}

TEST_CASE("Other blocks are counted, with a name and a remedy where there is one") {
  std::vector<std::uint8_t> stream;
  join(&stream, block_of({4109}, {}));
  join(&stream, block_of({4109, test::kTime_ms, test::kWeek, 7}, {}));
  join(&stream, block_of({8000}, {}));
  const SbfCounters c = decode_sbf(stream).counters;
  CHECK(c.unused.at(4109) == 2);
  CHECK(c.unused.at(8000) == 1);
  CHECK(unused_block_text(4109) == "Meas3Ranges (turn on MeasEpoch)");
  CHECK(unused_block_text(8000) == "block 8000");
}

}  // namespace leonav
