// Epochs and their ends, weeks, losses of lock and ephemerides.
#include "drivers/rtcm3/rtcm3_decoder.h"

#include <cmath>

#include "rtcm3_streams.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::BitEdit;
using test::decode_rtcm3;
using test::kDay;
using test::kMoreFollow;

constexpr std::size_t kStation = 12, kTime = 24, kSatelliteMask = 73;

// The GPS messages of the recording's first epochs, one second apart, each complete by itself.
std::vector<std::vector<std::uint8_t>> gps_frames(std::size_t count) {
  const auto bytes = test::stream_bytes(test::shared_data(test::kGmsd7));
  std::vector<std::vector<std::uint8_t>> frames;
  for (const auto& extent : test::frame_extents(bytes)) {
    if (extent.type != 1077 || frames.size() == count) continue;
    frames.push_back(
        test::edited(std::span(bytes).subspan(extent.first, extent.size), {{kMoreFollow, 1, 0}}));
  }
  return frames;
}

std::vector<std::uint8_t> joined(const std::vector<std::vector<std::uint8_t>>& frames) {
  std::vector<std::uint8_t> stream;
  for (const auto& frame : frames) test::append(&stream, frame);
  return stream;
}

BitEdit time_ms(std::uint32_t ms) { return {kTime, 30, ms}; }

}  // namespace

TEST_CASE("Messages of one time are one epoch, which the last of them ends") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kMixed));
  const auto decoded = decode_rtcm3(bytes, test::day(2022, 3, 15));
  REQUIRE(decoded.epochs.size() == 1);
  const RawEpoch& epoch = decoded.epochs[0];
  CHECK(epoch.observations.size() == 17 + 10 + 11);
  CHECK(std::is_sorted(
      epoch.observations.begin(), epoch.observations.end(), [](const auto& a, const auto& b) {
        return a.satellite != b.satellite ? a.satellite < b.satellite : a.code < b.code;
      }));
  // 204137.001 s of GPS time in GPS and Galileo, 14 s less in BeiDou: Tuesday.
  CHECK(epoch.time == GpsTime::from_week_and_tow(2201, 204'137.001));
  const Rtcm3Counters& c = decoded.counters;
  CHECK(c.epochs.epochs == 1);
  CHECK(c.epochs.messages == 3);
  CHECK(c.epochs.not_ended == 0);
  CHECK(c.unused.at(1087) == 1);
  CHECK(c.unused.at(1230) == 1);
  CHECK(c.unused.at(4072) == 1);
  CHECK(unused_message_text(1087) == "GLONASS observations (system not used)");
  CHECK(c.station_messages == 1);
  REQUIRE(decoded.positions.size() == 1);
  CHECK(decoded.positions[0].p_e.norm() == Approx(6'370'000.0).epsilon(0.01));
}

TEST_CASE("A lost last message costs itself: the next epoch's time ends the epoch as well") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kMixed));
  std::vector<std::uint8_t> stream;
  for (const auto& extent : test::frame_extents(bytes)) {
    if (extent.type != 1127) {
      test::append(&stream,
                   {bytes.begin() + static_cast<std::ptrdiff_t>(extent.first),
                    bytes.begin() + static_cast<std::ptrdiff_t>(extent.first + extent.size)});
    }
  }
  const auto cut = decode_rtcm3(stream, test::day(2022, 3, 15));
  REQUIRE(cut.epochs.size() == 1);  // at the end of the stream
  CHECK(cut.epochs[0].observations.size() == 17 + 10);
  CHECK(cut.counters.epochs.not_ended == 1);
  std::vector<std::uint8_t> twice = stream;
  for (const auto& extent : test::frame_extents(stream)) {
    if (extent.type != 1077) continue;
    test::append(&twice, test::edited(std::span(stream).subspan(extent.first, extent.size),
                                      {time_ms(204'138'001), {kMoreFollow, 1, 0}}));
  }
  const auto decoded = decode_rtcm3(twice, test::day(2022, 3, 15));
  REQUIRE(decoded.epochs.size() == 2);
  CHECK(decoded.epochs[0].observations.size() == 17 + 10);
  CHECK(decoded.epochs[1].observations.size() == 17);
  CHECK(seconds_between(decoded.epochs[1].time, decoded.epochs[0].time) == 1.0);
  CHECK(decoded.counters.epochs.not_ended == 1);
}

TEST_CASE("A message of an unused system may be the last of an epoch") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kMixed));
  std::vector<std::uint8_t> stream;
  for (const auto& extent : test::frame_extents(bytes)) {
    const auto frame = std::span(bytes).subspan(extent.first, extent.size);
    if (extent.type == 1077) test::append(&stream, {frame.begin(), frame.end()});
    if (extent.type == 1087) test::append(&stream, test::edited(frame, {{kMoreFollow, 1, 0}}));
  }
  Rtcm3Decoder decoder({test::day(2022, 3, 15)});
  test::Rtcm3Collector collector;
  decoder.feed(stream, &collector);
  CHECK(collector.epochs.size() == 1);  // without waiting for more
}

TEST_CASE("A sender that never says that more follows loses two epochs' rest and no more") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kMixed));
  std::vector<std::uint8_t> stream;
  for (std::uint32_t k = 0; k < 6; ++k) {
    for (const auto& extent : test::frame_extents(bytes)) {
      const auto frame = std::span(bytes).subspan(extent.first, extent.size);
      const std::uint32_t ms = (extent.type == 1127 ? 204'123'001u : 204'137'001u) + 1000 * k;
      if (extent.type == 1077 || extent.type == 1097 || extent.type == 1127) {
        test::append(&stream, test::edited(frame, {time_ms(ms), {kMoreFollow, 1, 0}}));
      }
    }
  }
  const auto decoded = decode_rtcm3(stream, test::day(2022, 3, 15));
  REQUIRE(decoded.epochs.size() == 6);
  CHECK(decoded.counters.epochs.late == 2 + 2);
  CHECK(decoded.counters.epochs.bit_is_wrong);
  for (std::size_t k = 0; k < 6; ++k) {
    CHECK(decoded.epochs[k].observations.size() == (k == 0 ? 17u : k == 1 ? 17u : 38u));
  }
}

TEST_CASE("The week is the one nearest to the reference, and goes on over the week's end") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  auto frames = gps_frames(4);
  const std::uint32_t end = 604'800'000;
  const std::uint32_t times[] = {end - 2000, end - 1000, 0, 1000};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i] = test::edited(frames[i], {time_ms(times[i])});
  }
  const auto stream = joined(frames);
  // 2012-10-14 is a Sunday: week 1710 begins. Three days before or after it must do.
  for (const int off : {-3, 0, 3}) {
    const auto decoded = decode_rtcm3(stream, kDay.plus_seconds(86'400.0 * off - 43'200.0));
    REQUIRE(decoded.epochs.size() == 4);
    CHECK(decoded.epochs[0].time == GpsTime::from_week_and_tow(1709, 604'798.0));
    CHECK(decoded.epochs[3].time == GpsTime::from_week_and_tow(1710, 1.0));
  }
  const auto unknown = decode_rtcm3(stream, GpsTime());
  CHECK(unknown.epochs.empty());
  CHECK(unknown.counters.epochs.without_reference == 4);
  // BeiDou's week ends 14 s later.
  const auto bytes = test::stream_bytes(test::shared_data(test::kGmsd7));
  for (const auto& extent : test::frame_extents(bytes)) {
    if (extent.type != 1127) continue;
    const auto frame =
        test::edited(std::span(bytes).subspan(extent.first, extent.size), {time_ms(end - 10'000)});
    const auto decoded = decode_rtcm3(frame, kDay);
    REQUIRE(decoded.epochs.size() == 1);
    CHECK(decoded.epochs[0].time == GpsTime::from_week_and_tow(1710, 4.0));
    break;
  }
}

TEST_CASE("Impossible times, masks and stations cost their message and are counted") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto frames = gps_frames(5);
  std::vector<std::uint8_t> stream;
  test::append(&stream, frames[0]);
  test::append(&stream, test::edited(frames[1], {time_ms(604'800'000)}));
  test::append(&stream, test::edited(frames[2], {{kSatelliteMask, 32, 0xFFFFFFFF}}));
  test::append(&stream, test::edited(frames[3], {{kStation, 12, 77}}));
  std::vector<std::uint8_t> cut(frames[4].begin() + 3, frames[4].begin() + 100);
  test::append(&stream, test::framed(cut));
  const auto decoded = decode_rtcm3(stream, kDay);
  REQUIRE(decoded.epochs.size() == 1);
  CHECK(decoded.counters.epochs.bad_time == 1);
  CHECK(decoded.counters.epochs.bad_mask == 1);
  CHECK(decoded.counters.epochs.other_station == 1);
  CHECK(decoded.counters.epochs.bad_length == 1);
}

TEST_CASE("Another station is used after a new connection, or once it has sent alone") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const bool is_new_connection = GENERATE(true, false);
  const auto frames = gps_frames(10);
  REQUIRE(frames.size() == 10);
  Rtcm3Decoder decoder({kDay});
  test::Rtcm3Collector collector;
  for (std::size_t k = 0; k < 3; ++k) decoder.feed(frames[k], &collector);
  REQUIRE(collector.epochs.size() == 3);
  if (is_new_connection) decoder.allow_other_station();
  for (std::size_t k = 3; k < 10; ++k) {
    decoder.feed(test::edited(frames[k], {{kStation, 12, 200}}), &collector);
  }
  // Five seconds of the other one alone, from its first message on, pass.
  const std::size_t refused = is_new_connection ? 0 : 5;
  CHECK(decoder.counters().epochs.other_station == refused);
  REQUIRE(collector.epochs.size() == 10 - refused);
  for (const auto& o : collector.epochs[3].observations) {
    if (std::isfinite(o.carrier_cycles)) CHECK(o.loss_of_lock);  // it is another receiver's carrier
  }
  const auto undisturbed = decode_rtcm3(joined(frames), kDay);
  const RawEpoch& next = undisturbed.epochs[is_new_connection ? 4 : 9];
  REQUIRE(collector.epochs[4].observations.size() == next.observations.size());
  for (std::size_t i = 0; i < next.observations.size(); ++i) {
    CHECK(collector.epochs[4].observations[i].loss_of_lock == next.observations[i].loss_of_lock);
  }
}

TEST_CASE("A station that comes back in a new connection keeps its carriers, and another between") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto frames = gps_frames(9);
  Rtcm3Decoder decoder({kDay});
  test::Rtcm3Collector collector;
  for (std::size_t k = 0; k < 9; ++k) {
    if (k == 2) decoder.allow_other_station();
    decoder.feed(frames[k], &collector);
    decoder.feed(test::edited(frames[k], {{kStation, 12, 200}}), &collector);
  }
  CHECK(collector.epochs.size() == 9);
  CHECK(decoder.counters().epochs.other_station == 9);
  for (const auto& o : collector.epochs[2].observations) CHECK_FALSE(o.loss_of_lock);
}

TEST_CASE("Lock times that start again are losses of lock, and values not measured are left out") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  auto frames = gps_frames(3);
  const auto before = decode_rtcm3(joined(frames), kDay);
  REQUIRE(before.epochs.size() == 3);
  const std::size_t n = before.epochs[0].observations.size();
  // 12 satellites, 4 signals: where the fields of the 28 cells begin.
  const std::size_t cells = 28, satellites = 12;
  REQUIRE(n == cells);
  const std::size_t rough = 169 + satellites * 4;
  const std::size_t range = rough + satellites * 36, phase = range + cells * 20;
  const std::size_t lock = phase + cells * 24, half = lock + cells * 10;
  for (const auto& o : before.epochs[2].observations) CHECK_FALSE(o.loss_of_lock);
  frames[2] = test::edited(frames[2], {{lock, 10, 100},                 // 144 ms
                                       {lock + 10, 10, 0},              // 0 ms
                                       {half + 1, 1, 1},                // second cell
                                       {range + 2 * 20, 20, 0x80000},   // third: no code
                                       {phase + 2 * 24, 24, 0x800000},  // and no carrier
                                       {rough + 8, 8, 255}});  // second satellite: no range
  const auto after = decode_rtcm3(joined(frames), kDay);
  REQUIRE(after.epochs.size() == 3);
  const auto& o = after.epochs[2].observations;
  CHECK(o[0].loss_of_lock);
  CHECK(o[0].lock_time_s == 0.144);
  CHECK_FALSE(o[0].half_cycle_ambiguous);
  CHECK(o[1].loss_of_lock);
  CHECK(o[1].half_cycle_ambiguous);
  // The third signal has no Doppler either and is left out; so are those of the second satellite
  // that have none, and its first signal keeps its Doppler alone.
  CHECK(after.counters.measurements.empty > 0);
  for (const auto& each : o) {
    if (each.satellite.number != 3) continue;
    CHECK(std::isnan(each.pseudorange_m));
    CHECK(std::isnan(each.carrier_cycles));
    CHECK(std::isfinite(each.doppler_hz));
  }
}

TEST_CASE("Ephemerides come once per contents, of the stream's week only, sent when they came") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kGmsd7));
  const auto decoded = decode_rtcm3(bytes, kDay);
  const Rtcm3EphemerisCounters& c = decoded.counters.ephemerides;
  CHECK(c.ephemerides + c.repeated == 15);
  CHECK(c.ephemerides == decoded.ephemerides.size());
  for (const Ephemeris& e : decoded.ephemerides) {
    CHECK(std::abs(seconds_between(e.transmission_time, e.toe)) < 7200.0 + 3600.0);
  }
  const auto years_later = decode_rtcm3(bytes, test::day(2013, 10, 14));
  CHECK(years_later.ephemerides.empty());
  CHECK(years_later.counters.ephemerides.bad_week == 15);
  // A stream of ephemerides alone has the time that it is told.
  Rtcm3Decoder decoder;
  test::Rtcm3Collector collector;
  std::vector<std::uint8_t> alone;
  for (const auto& extent : test::frame_extents(bytes)) {
    if (extent.type != 1019) continue;
    const auto frame = std::span(bytes).subspan(extent.first, extent.size);
    test::append(&alone, {frame.begin(), frame.end()});
  }
  decoder.feed(alone, &collector);
  CHECK(decoder.counters().ephemerides.without_reference == 15);
  decoder.tell_time(kDay);
  decoder.feed(alone, &collector);
  REQUIRE(collector.ephemerides.size() == decoded.ephemerides.size());
  CHECK(collector.ephemerides[0].transmission_time == kDay);
}

}  // namespace leonav
