// Messages packed here by the manual's tables: what becomes of them, and of those that cannot be
// used.
#include <cmath>

#include "oem7_streams.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::Bytes;
using test::decode_oem7;
using test::message_of;
using test::range_of;
using test::RangeRecord;
using test::tracking;

void join(std::vector<std::uint8_t>* stream, const std::vector<std::uint8_t>& more) {
  stream->insert(stream->end(), more.begin(), more.end());
}

std::vector<std::uint8_t> range_message(std::vector<RangeRecord> records,
                                        std::uint32_t milliseconds = test::kTime_ms) {
  return message_of({43, milliseconds}, range_of(records));
}

// RAWIMUX and RAWIMUSX: the manual's example of an Epson G320 (type 41), lying still.
std::vector<std::uint8_t> imu_payload(std::uint8_t info, std::uint8_t type, double tow_s) {
  Bytes bytes;
  bytes.u1(info).u1(type).u2(test::kWeek).r8(tow_s).u4(0xea59fe00);
  bytes.i4(329308016).i4(-2706935).i4(4508389).i4(196192).i4(417138).i4(-1000837);
  return bytes.list;
}
std::vector<std::uint8_t> plain_imu_payload(double tow_s) {
  const auto extended = imu_payload(0, 0, tow_s);
  Bytes bytes;
  return bytes.u4(test::kWeek).join(std::span(extended).subspan(4)).list;
}

}  // namespace

TEST_CASE("A range log is an epoch with its last byte") {
  const auto message = range_message({{}});
  test::Oem7Collector collector;
  Oem7Decoder decoder;
  decoder.feed(std::span(message).first(message.size() - 1), &collector);
  CHECK(collector.epochs.empty());
  decoder.feed(std::span(message).last(1), &collector);
  REQUIRE(collector.epochs.size() == 1);
  CHECK(collector.epochs[0].time == test::time_at(test::kTime_ms));
  REQUIRE(collector.epochs[0].observations.size() == 1);
  const SignalObservation& o = collector.epochs[0].observations[0];
  CHECK(o.satellite == SatelliteId{System::kGps, 5});
  CHECK(o.code == SignalCode{'1', 'C'});
  CHECK(o.pseudorange_m == 21'761'200.335);
  CHECK(o.carrier_cycles == 114'355'879.993);
  CHECK(o.doppler_hz == 1121.758F);
  CHECK(o.cn0_dbhz == 50.0);
  CHECK(o.lock_time_s == 876.785F);
  CHECK_FALSE(o.half_cycle_ambiguous);
  CHECK_FALSE(o.loss_of_lock);
}

TEST_CASE(
    "Values count while their loops are locked, and a carrier of unknown parity is ambiguous") {
  constexpr std::uint32_t kPhase = 1u << 10, kParity = 1u << 11, kCode = 1u << 12;
  const auto decoded = decode_oem7(range_message({{1, tracking(0, 0, kPhase | kParity)},
                                                  {2, tracking(0, 0, kCode)},
                                                  {3, tracking(0, 0, kCode | kPhase)},
                                                  {4, tracking(0, 0, 0)}}));
  REQUIRE(decoded.epochs.size() == 1);
  const auto& all = decoded.epochs[0].observations;
  REQUIRE(all.size() == 3);
  CHECK(std::isnan(all[0].pseudorange_m));
  CHECK(std::isfinite(all[0].carrier_cycles));
  CHECK_FALSE(all[0].half_cycle_ambiguous);
  CHECK(std::isfinite(all[1].pseudorange_m));
  CHECK(std::isnan(all[1].carrier_cycles));
  CHECK(std::isfinite(all[1].doppler_hz));
  CHECK(all[2].half_cycle_ambiguous);
  CHECK(decoded.counters.epochs.empty == 1);
}

TEST_CASE("What cannot be used of a range log is counted by its reason") {
  RangeRecord glonass{38, tracking(1, 0)}, signal{5, tracking(0, 31)}, number{0, tracking(0, 0)};
  RangeRecord far{6, tracking(0, 0)}, twice{7, tracking(4, 0)}, again{7, tracking(4, 4)};
  RangeRecord nothing{8, tracking(3, 2)}, large{60'000, tracking(3, 2)};
  far.range_m = 1e12;
  nothing.range_m = nothing.adr_cycles = std::nan("");
  nothing.doppler_hz = INFINITY;
  const auto decoded =
      decode_oem7(range_message({glonass, signal, number, far, twice, again, nothing, large}));
  const RangeEpochCounters& c = decoded.counters.epochs;
  REQUIRE(decoded.epochs.size() == 1);
  CHECK(c.measurements == 2);
  CHECK(c.other_system == 1);
  CHECK(c.unknown_signal == 1);
  CHECK(c.bad_satellite == 2);
  CHECK(c.bad_value == 2);  // the range, and a Doppler without end
  CHECK(c.duplicates == 1);
  CHECK(c.empty == 1);
}

TEST_CASE(
    "Logs without time, of the second antenna, in answer to a command and twice give no epoch") {
  const auto payload = range_of(std::vector<RangeRecord>{{}});
  std::vector<std::uint8_t> stream;
  join(&stream, message_of({43, test::kTime_ms, 0, 20}, payload));
  join(&stream, message_of({43, test::kTime_ms, 0, 180, 0}, payload));
  join(&stream, message_of({43, 700'000'000}, payload));
  join(&stream, message_of({43, test::kTime_ms, 1}, payload));
  join(&stream, message_of({43, test::kTime_ms, 0x80}, payload));
  CHECK(decode_oem7(stream).epochs.empty());
  join(&stream, message_of({43, test::kTime_ms, 2}, payload));  // OEM-V sets such bits
  join(&stream, message_of({43}, payload));
  const auto decoded = decode_oem7(stream);
  CHECK(decoded.epochs.size() == 1);
  CHECK(decoded.counters.ranges.without_time == 3);
  CHECK(decoded.counters.second_antenna == 1);
  CHECK(decoded.counters.responses == 1);
  CHECK(decoded.counters.epochs.repeated == 1);
  CHECK(decoded.counters.framer.messages == 7);
}

TEST_CASE("A log that holds less than it claims is refused") {
  for (const std::uint16_t id : {43, 140, 1273, 2050}) {
    Bytes more;
    more.u4(0xFFFFFFFF).join(std::vector<std::uint8_t>(60));
    const auto decoded = decode_oem7(message_of({id}, more.list));
    CAPTURE(id);
    CHECK(decoded.epochs.empty());
    CHECK(decoded.counters.ranges.bad_length == 1);
    CHECK(decode_oem7(message_of({id}, {})).counters.ranges.bad_length == 1);
  }
}

TEST_CASE("A carrier whose lock began anew, or whose half cycle was added, is told as lost") {
  struct Step {
    std::uint32_t after_ms;
    float lock_s;
    bool is_added, is_lost;
  };
  std::vector<std::uint8_t> stream;
  std::uint32_t now = test::kTime_ms;
  const Step steps[] = {{0, 100.0F, false, false},  {1000, 101.0F, false, false},
                        {1000, 0.5F, false, true},  {1000, 1.5F, false, false},
                        {1000, 2.5F, true, true},   {1000, 3.5F, true, false},
                        {10'000, 5.0F, true, true}, {1000, 6.0F, true, false},
                        {1000, 0.0F, true, true},   {20'000, 20.0F, true, false}};
  for (const Step& step : steps) {
    now += step.after_ms;
    RangeRecord record;
    record.lock_s = step.lock_s;
    record.status |= (step.is_added ? 1u : 0u) << 28;
    join(&stream, range_message({record}, now));
  }
  const auto decoded = decode_oem7(stream);
  REQUIRE(decoded.epochs.size() == std::size(steps));
  for (std::size_t i = 0; i < std::size(steps); ++i) {
    CAPTURE(i);
    CHECK(decoded.epochs[i].observations[0].loss_of_lock == steps[i].is_lost);
  }
}

TEST_CASE("Differences of RANGECMP4 need the reference of their second") {
  // One GPS satellite, number 3, L1 C/A; LSB first. 8 bits at a time would hide the fields.
  const auto log = [](bool is_difference, std::uint32_t block, std::int64_t a, std::int64_t b,
                      std::int64_t c) {
    std::vector<bool> bits;
    const auto put = [&bits](std::uint64_t value, int count) {
      for (int i = 0; i < count; ++i) bits.push_back(((value >> i) & 1u) != 0);
    };
    put(1, 16), put(1u << 2, 64), put(1u << 1, 16), put(1, 1);
    put(is_difference, 1), put(block, 3);
    put(1, 1), put(0, 1), put(900, 11), put(8, 4), put(2, 4), put(3, 4);
    put(static_cast<std::uint64_t>(a), is_difference ? 19 : 37);
    put(static_cast<std::uint64_t>(b), is_difference ? 16 : 23);
    put(static_cast<std::uint64_t>(c), is_difference ? 18 : 26);
    Bytes bytes;
    bytes.u4((bits.size() + 7) / 8);
    for (std::size_t i = 0; i < bits.size(); i += 8) {
      std::uint64_t byte = 0;
      for (std::size_t k = i; k < std::min(i + 8, bits.size()); ++k)
        byte |= std::uint64_t{bits[k]} << (k - i);
      bytes.u1(byte);
    }
    return bytes.list;
  };
  constexpr std::uint32_t kStart = test::kTime_ms;
  const auto reference = log(false, 5, 43'522'400'670, -1234, 2'134'500);  // 213.45 m/s
  const auto difference = log(true, 5, 200, 50, -30);
  std::vector<std::uint8_t> stream;
  join(&stream, message_of({2050, kStart - 250}, difference));  // nothing to refer to
  join(&stream, message_of({2050, kStart}, reference));
  join(&stream, message_of({2050, kStart + 250}, difference));
  join(&stream, message_of({2050, kStart + 500}, log(true, 4, 200, 50, -30)));  // another block
  join(&stream, message_of({2050, kStart + 1250}, difference));  // of the next second
  // The most negative differences, and the largest range, are no values.
  join(&stream, message_of({2050, kStart + 750}, log(true, 5, -(1 << 18), -(1 << 15), -(1 << 17))));
  join(&stream, message_of({2050, kStart + 3000}, log(false, 5, (1LL << 37) - 1, 0, -(1 << 25))));
  const auto decoded = decode_oem7(stream);
  CHECK(decoded.counters.ranges.bad_length == 0);
  CHECK(decoded.counters.ranges.without_reference == 3);
  CHECK(decoded.counters.epochs.empty == 5);
  REQUIRE(decoded.epochs.size() == 7);
  const double wavelength = 299'792'458.0 / 1575.42e6;
  const auto& whole = decoded.epochs[1].observations;
  const auto& quarter = decoded.epochs[2].observations;
  REQUIRE((whole.size() == 1 && quarter.size() == 1));
  CHECK(whole[0].satellite == SatelliteId{System::kGps, 3});
  CHECK(whole[0].pseudorange_m == Approx(21'761'200.335).epsilon(1e-15));
  CHECK(whole[0].carrier_cycles == Approx((21'761'200.335 - 0.1234) / wavelength).epsilon(1e-15));
  CHECK(whole[0].doppler_hz == Approx(-213.45 / wavelength).epsilon(1e-15));
  CHECK(whole[0].cn0_dbhz == Approx(45.0));
  CHECK(whole[0].lock_time_s == 2.048);
  const double moved = 213.45 * 0.25;
  CHECK(quarter[0].pseudorange_m == Approx(21'761'200.335 + moved + 0.1).epsilon(1e-15));
  CHECK(quarter[0].carrier_cycles ==
        Approx((21'761'200.335 - 0.1234 + moved + 0.005) / wavelength).epsilon(1e-15));
  CHECK(quarter[0].doppler_hz == Approx(-(213.45 - 0.003) / wavelength).epsilon(1e-15));
}

TEST_CASE("Inertial counts become increments forward, right, down") {
  std::vector<std::uint8_t> stream;
  join(&stream, test::short_message_of(1462, test::kTime_ms, imu_payload(0, 41, 491'674.0)));
  join(&stream, message_of({1461}, imu_payload(0, 41, 491'674.008)));
  join(&stream, test::short_message_of(325, test::kTime_ms, plain_imu_payload(491'674.016)));
  join(&stream, message_of({268}, plain_imu_payload(491'674.024)));
  const auto decoded = decode_oem7(stream);
  REQUIRE(decoded.increments.size() == 4);
  const RawImuIncrements& first = decoded.increments[0];
  CHECK(first.time == GpsTime::from_week_and_tow(test::kWeek, 491'674.0));
  // At 125 Hz: 9.86 m/s^2 against gravity, up.
  CHECK(first.delta_velocity_m_s[2] * 125.0 == Approx(-9.8554).epsilon(1e-4));
  // The manual's fields are -y = -2706935, x = 4508389: y forward, x to the right.
  const double accel = 0.2 / 65536.0 * 9.80665e-3, gyro = 0.008 / 65536.0 * M_PI / 180.0;
  CHECK(first.delta_velocity_m_s[0] * 125.0 == Approx(2706935 * accel).epsilon(1e-12));
  CHECK(first.delta_velocity_m_s[1] * 125.0 == Approx(4508389 * accel).epsilon(1e-12));
  CHECK(first.delta_theta_rad[0] * 125.0 == Approx(-417138 * gyro).epsilon(1e-12));
  CHECK(first.delta_theta_rad[1] * 125.0 == Approx(-1000837 * gyro).epsilon(1e-12));
  CHECK(first.delta_theta_rad[2] * 125.0 == Approx(-196192 * gyro).epsilon(1e-12));
  for (const RawImuIncrements& each : decoded.increments) {
    CHECK(each.delta_velocity_m_s == first.delta_velocity_m_s);
    CHECK(each.delta_theta_rad == first.delta_theta_rad);
  }
}

TEST_CASE("Inertial data that cannot be used are counted by their reason") {
  std::vector<std::uint8_t> stream;
  join(&stream, message_of({268}, plain_imu_payload(1.0)));  // no type is known yet
  join(&stream, message_of({1461}, imu_payload(0, 49, 1.0)));
  join(&stream, message_of({1461}, imu_payload(1, 41, 1.0)));
  join(&stream, message_of({1461}, imu_payload(2, 41, 1.0)));
  join(&stream, message_of({1461}, imu_payload(0, 41, 604'800.0)));
  join(&stream, message_of({1461}, imu_payload(0, 41, std::nan(""))));
  join(&stream, message_of({268}, {}));
  join(&stream, test::short_message_of(1462, 0, {}));
  const auto decoded = decode_oem7(stream);
  CHECK(decoded.increments.empty());
  const RawImuCounters& c = decoded.counters.imu;
  CHECK(c.unknown_scale == 2);
  CHECK(c.type_without_scale == 49u);
  CHECK(c.sensor_errors == 1);
  CHECK(c.encrypted == 1);
  CHECK(c.bad_time == 2);
  CHECK(c.bad_length == 2);
  // A scale that is told serves for every type; INSCONFIG tells the type of RAWIMU.
  const auto told = decode_oem7(stream, 4096, {ImuScale{1e-9, 1e-8}});
  REQUIRE(told.increments.size() == 2);
  CHECK(told.increments[1].delta_velocity_m_s[2] == Approx(-329308016 * 1e-8));
  auto with_type = message_of({1945}, Bytes().u4(58).list);
  join(&with_type, message_of({268}, plain_imu_payload(1.0)));
  REQUIRE(decode_oem7(with_type).increments.size() == 1);
}

TEST_CASE(
    "OEM7's logs of Galileo are read in the length of their tables, and refused in any other") {
  const auto log_of = [](std::uint16_t id, bool is_inav, double sqrt_a, std::uint32_t toe_s) {
    Bytes bytes;
    bytes.u4(11).u4(0);
    if (is_inav) bytes.u1(2).u1(0).u2(0);  // E1-B is out of service
    bytes.u2(68).u1(107).u1(3).u4(toe_s).u4(501'600);
    for (const double value : {1.9, 3e-9, 3e-4, sqrt_a, 0.97, 5e-10, 0.6, 0.3, -5e-9})
      bytes.r8(value);
    for (const double value : {7e-6, 4e-6, 240.0, 161.0, -5e-8, 2e-8, 3e-4, 2e-12, 0.0, -7e-10}) {
      bytes.r8(value);
    }
    if (is_inav) bytes.r8(-1.6e-9);
    return std::pair{id, bytes.list};
  };
  const auto inav = log_of(1309, true, 5440.6, 501'600).second;
  const auto fnav = log_of(1310, false, 5440.6, 501'600).second;
  CHECK(inav.size() == 184);
  CHECK(fnav.size() == 172);
  std::vector<std::uint8_t> stream = message_of({1309}, inav);
  join(&stream, message_of({1310}, fnav));
  join(&stream, message_of({1309}, inav));
  const auto good = decode_oem7(stream);
  REQUIRE(good.ephemerides.size() == 2);
  CHECK(good.counters.ephemerides.repeated == 1);
  CHECK(good.counters.unused.empty());
  CHECK(good.ephemerides[0].message == NavigationMessage::kGalileoInav);
  CHECK(good.ephemerides[0].health == 2 << 1);
  CHECK(good.ephemerides[0].group_delay_s[1] == -1.6e-9);
  CHECK(good.ephemerides[1].message == NavigationMessage::kGalileoFnav);
  CHECK(good.ephemerides[1].health == 0);

  // The fields of early firmware, and lengths around those of the tables.
  stream.clear();
  for (const std::size_t size : {0u, 171u, 173u, 180u, 183u, 185u, 188u}) {
    auto longer = inav;
    longer.resize(size);
    join(&stream, message_of({1309}, longer));
    join(&stream, message_of({1310}, longer));
  }
  join(&stream, message_of({1309}, log_of(1309, true, 54.0, 501'600).second));
  join(&stream, message_of({1310}, log_of(1310, false, 5440.6, 604'800).second));
  join(&stream, message_of({1309, test::kTime_ms, 0, 20}, inav));
  auto number = inav;
  number[0] = 200;
  join(&stream, message_of({1309}, number));
  const auto bad = decode_oem7(stream);
  CHECK(bad.ephemerides.empty());
  CHECK(bad.counters.ephemerides.bad_length == 14);
  CHECK(bad.counters.ephemerides.not_sane == 1);
  CHECK(bad.counters.ephemerides.bad_time == 1);
  CHECK(bad.counters.ephemerides.without_time == 1);
  CHECK(bad.counters.ephemerides.bad_satellite == 1);
}

TEST_CASE("Logs that are not used are counted by number, and have names") {
  std::vector<std::uint8_t> stream = message_of({42}, std::vector<std::uint8_t>(72));
  join(&stream, message_of({1336}, std::vector<std::uint8_t>(228)));
  join(&stream, message_of({9999}, {}));
  join(&stream, message_of({9999}, {}));
  const auto decoded = decode_oem7(stream);
  CHECK(decoded.counters.unused ==
        std::map<std::uint16_t, std::uint64_t>{{42, 1}, {1336, 1}, {9999, 2}});
  CHECK(unused_log_text(42) == "BESTPOS");
  CHECK(unused_log_text(1336) == "QZSSEPHEMERIS (system not used)");
  CHECK(unused_log_text(9999) == "log 9999");
}

TEST_CASE("Recorded INS streams are whole, and their logs counted") {
  if (!test::have_shared_data(test::kIns1) || !test::have_shared_data(test::kIns2)) return;
  const auto one = decode_oem7(test::stream_bytes(test::shared_data(test::kIns1)));
  CHECK(one.counters.framer.bytes_skipped == 0);
  CHECK(one.counters.unused ==
        std::map<std::uint16_t, std::uint64_t>{{508, 243}, {2051, 29}, {2264, 10}});
  const auto two = decode_oem7(test::stream_bytes(test::shared_data(test::kIns2)));
  CHECK(two.counters.framer.messages == 835);
  CHECK(two.counters.framer.bytes_skipped == 0);
}

}  // namespace leonav
