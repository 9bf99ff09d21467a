// Damaged, cut and random streams: nothing crashes, every loss is counted; and whole files.
#include <algorithm>
#include <random>

#include "drivers/rtcm3/rtcm3_file_reader.h"
#include "rtcm3_streams.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::decode_rtcm3;
using test::kDay;

}  // namespace

TEST_CASE("Chunks of any size give the same outputs") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kGmsd7));
  const auto whole = decode_rtcm3(bytes, kDay, bytes.size());
  // GPS and BeiDou apart: this receiver gave BeiDou the time of GPS.
  REQUIRE(whole.epochs.size() == 2 * 257);
  for (const std::size_t chunk : {1u, 7u, 4096u}) {
    const auto parts = decode_rtcm3(bytes, kDay, chunk);
    REQUIRE(parts.epochs.size() == whole.epochs.size());
    CHECK(parts.ephemerides.size() == whole.ephemerides.size());
    CHECK(std::equal(parts.epochs.begin(), parts.epochs.end(), whole.epochs.begin(),
                     test::same_epoch));
  }
}

TEST_CASE("Messages of random contents with a good checksum do no harm") {
  std::mt19937 random(4711);
  std::vector<std::uint8_t> stream;
  const std::uint16_t types[] = {1005, 1006, 1007, 1008, 1019, 1033, 1042, 1045, 1046, 1071, 1074,
                                 1075, 1076, 1077, 1087, 1094, 1095, 1096, 1097, 1124, 1125, 1126,
                                 1127, 1137, 1230, 1057, 1060, 1242, 1265, 4076, 0,    4095};
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> message(random() % 300);
    for (auto& byte : message) byte = static_cast<std::uint8_t>(random());
    // Few bits in the masks, so that some messages are whole.
    if (message.size() > 28 && random() % 2 == 0) {
      for (std::size_t k = 9; k < 21; ++k)
        message[k] &= static_cast<std::uint8_t>(random() & random() & random());
    }
    if (message.size() >= 2) {
      const std::uint16_t type = types[random() % std::size(types)];
      message[0] = static_cast<std::uint8_t>(type >> 4);
      message[1] = static_cast<std::uint8_t>((type << 4) | (message[1] & 0xF));
      if (message.size() > 2) message[1] &= 0xF0, message[2] = 0;  // one station
    }
    test::append(&stream, test::framed(message));
  }
  const auto decoded = decode_rtcm3(stream, kDay, 1000);
  CHECK(decoded.counters.framer.frames == 20'000);
  CHECK(decoded.counters.framer.bytes_skipped == 0);
  CHECK(decoded.counters.epochs.epochs > 0);
  CHECK(decoded.counters.epochs.bad_length > 0);
  CHECK(decoded.counters.epochs.bad_mask > 0);
  for (const RawEpoch& epoch : decoded.epochs) {
    for (std::size_t i = 1; i < epoch.observations.size(); ++i) {
      const auto &a = epoch.observations[i - 1], &b = epoch.observations[i];
      CHECK((a.satellite < b.satellite || (a.satellite == b.satellite && a.code < b.code)));
    }
  }
}

TEST_CASE("A recording cut at any byte, or with flipped bits, gives what is whole") {
  if (!test::have_shared_data(test::kMixed) || !test::have_shared_data(test::kManyTypes)) return;
  const auto clean = test::stream_bytes(test::shared_data(test::kMixed));
  for (std::size_t size = 0; size < clean.size(); ++size) {
    const auto cut = decode_rtcm3(std::span(clean).first(size), test::day(2022, 3, 15));
    CHECK(cut.counters.framer.frames <= 7);
    CHECK(cut.epochs.size() <= 1);
  }
  const auto many = test::stream_bytes(test::shared_data(test::kManyTypes));
  std::mt19937 random(99);
  for (int i = 0; i < 300; ++i) {
    auto damaged = many;
    for (int k = 0; k < 20; ++k) {
      damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    }
    const auto decoded = decode_rtcm3(damaged, test::day(2024, 3, 20));
    CHECK(decoded.counters.framer.frames < 35);
    CHECK(decoded.counters.framer.bytes_skipped > 0);
  }
}

TEST_CASE("A file that is absent or a directory is an error that names it") {
  CHECK_THROWS_WITH(Rtcm3FileReader("no/such/file.rtcm3", {}), Catch::Contains("no/such/file"));
  CHECK_THROWS_WITH(Rtcm3FileReader(LEONAV_SOURCE_DIR, {}), Catch::Contains("directory"));
}

TEST_CASE("A file gives its outputs in order and the antenna that it names") {
  if (!test::have_shared_data(test::kManyTypes)) return;
  const std::string path = test::shared_data(test::kManyTypes);
  CHECK(first_antenna(path) == "SEPCHOKE_B3E6   SPKE");
  Rtcm3FileReader reader(path, {test::day(2024, 3, 20)});
  std::size_t epochs = 0, ephemerides = 0, others = 0;
  for (Rtcm3Output output; reader.next(&output);) {
    epochs += std::holds_alternative<RawEpoch>(output);
    ephemerides += std::holds_alternative<Ephemeris>(output);
    others +=
        !std::holds_alternative<RawEpoch>(output) && !std::holds_alternative<Ephemeris>(output);
  }
  CHECK(epochs == 1);
  CHECK(ephemerides == 4);
  CHECK(others == 5);
  // Each signal comes in MSM6 and in MSM7: the first is used.
  CHECK(reader.counters().measurements.duplicates == 42 + 35 + 23);
  CHECK(reader.counters().measurements.measurements == 42 + 35 + 23);
}

}  // namespace leonav
