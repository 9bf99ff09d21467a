// Damaged, cut and random streams: nothing crashes, every loss is counted; and whole files.
#include <algorithm>
#include <random>

#include "drivers/oem7/oem7_file_reader.h"
#include "drivers/text/parse.h"
#include "oem7_streams.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::decode_oem7;

constexpr std::uint16_t kUsed[] = {7,    8,    41,   43,   140,  268,  325,  1122,
                                   1273, 1309, 1310, 1461, 1462, 1696, 1945, 2050};

std::vector<std::uint8_t> random_bytes(std::mt19937* random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>((*random)());
  return bytes;
}

// Messages of every used log with random contents, of which some have small counts in front.
std::vector<std::uint8_t> random_stream(int count) {
  std::mt19937 random(4711);
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < count; ++i) {
    auto payload = random_bytes(&random, random() % 300);
    if (payload.size() > 4 && random() % 2 == 0) {
      payload[0] = static_cast<std::uint8_t>(random() % (payload.size() - 3));
      payload[1] = payload[2] = payload[3] = 0;
    }
    const std::uint16_t id = kUsed[random() % std::size(kUsed)];
    const auto time = static_cast<std::uint32_t>(test::kTime_ms + 250 * i);
    const bool is_short = payload.size() < 256 && random() % 2 == 0;
    const auto message = is_short ? test::short_message_of(id, time, payload)
                                  : test::message_of({id, time}, payload);
    stream.insert(stream.end(), message.begin(), message.end());
  }
  return stream;
}

std::vector<std::uint8_t> recording() { return test::stream_bytes(test::shared_data(test::kOemv)); }

}  // namespace

TEST_CASE("Chunks of any size give the same outputs") {
  if (!test::have_shared_data(test::kOemv)) return;
  const auto bytes = recording();
  const auto whole = decode_oem7(bytes, bytes.size());
  REQUIRE(whole.epochs.size() == 46);
  for (const std::size_t chunk : {1u, 7u, 4096u}) {
    const auto parts = decode_oem7(bytes, chunk);
    REQUIRE(parts.epochs.size() == whole.epochs.size());
    CHECK(parts.ephemerides.size() == whole.ephemerides.size());
    CHECK(parts.counters.framer.bytes_skipped == whole.counters.framer.bytes_skipped);
    CHECK(std::equal(parts.epochs.begin(), parts.epochs.end(), whole.epochs.begin(),
                     test::same_epoch));
  }
}

TEST_CASE("Messages of random contents with a good checksum do no harm") {
  const auto decoded = decode_oem7(random_stream(20'000), 1000);
  CHECK(decoded.counters.framer.messages == 20'000);
  CHECK(decoded.counters.framer.bytes_skipped == 0);
  CHECK(decoded.counters.ranges.bad_length > 1000);
  CHECK(decoded.counters.epochs.epochs > 50);
  CHECK(decoded.counters.epochs.bad_value > 0);
  CHECK(decoded.counters.ephemerides.bad_length > 0);
  CHECK(decoded.counters.ephemerides.bad_satellite > 0);
  CHECK(decoded.counters.ephemerides.ephemerides == 0);
}

TEST_CASE("A stream may end at every byte") {
  const auto stream = random_stream(40);
  for (std::size_t size = 0; size <= stream.size(); ++size) {
    const auto decoded = decode_oem7(std::span(stream).first(size));
    const auto& framer = decoded.counters.framer;
    REQUIRE(framer.messages <= 40);
    REQUIRE((framer.messages == 40) == (size == stream.size()));
  }
}

TEST_CASE("A damaged length holds back no message behind it") {
  const test::RangeRecord record;
  const auto payload = test::range_of(std::span(&record, 1));
  Oem7Decoder decoder;
  test::Oem7Collector collector;
  for (std::uint32_t k = 0; k < 6; ++k) {
    auto bytes = test::message_of({43, test::kTime_ms + 200 * k}, payload);
    if (k == 2) bytes[9] ^= 0x20;  // 8192 bytes more, which would take seconds to come
    decoder.feed(bytes, &collector);
    // Each epoch comes out with its own last byte.
    REQUIRE(collector.epochs.size() == (k < 2 ? k + 1 : k));
  }
  CHECK(collector.epochs.back().time == test::time_at(test::kTime_ms + 1000));
  decoder.finish(&collector);
  CHECK(decoder.counters().framer.messages == 5);
  CHECK(decoder.counters().framer.bad_checksums + decoder.counters().framer.incomplete == 1);
}

TEST_CASE("A flipped bit costs the message it is in and no other") {
  if (!test::have_shared_data(test::kOemv)) return;
  const auto clean = recording();
  const auto messages = test::message_extents(clean);
  const auto reference = decode_oem7(clean);
  REQUIRE(messages.size() == reference.counters.framer.messages);
  for (const std::size_t step : {997u, 5003u, 40009u}) {
    auto damaged = clean;
    for (std::size_t i = step / 2; i < damaged.size(); i += step) {
      damaged[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
    }
    const auto untouched = std::count_if(messages.begin(), messages.end(), [&](const auto& m) {
      const auto first = clean.begin() + static_cast<std::ptrdiff_t>(m.first);
      return std::equal(first, first + static_cast<std::ptrdiff_t>(m.size),
                        damaged.begin() + static_cast<std::ptrdiff_t>(m.first));
    });
    const auto decoded = decode_oem7(damaged);
    CHECK(decoded.counters.framer.messages == static_cast<std::uint64_t>(untouched));
    for (const RawEpoch& epoch : decoded.epochs) {
      CHECK(std::any_of(reference.epochs.begin(), reference.epochs.end(),
                        [&epoch](const RawEpoch& r) { return test::same_epoch(r, epoch); }));
    }
  }
}

TEST_CASE("Many flipped bits anywhere do no harm") {
  const auto clean = random_stream(60);
  std::mt19937 random(42);
  for (int round = 0; round < 500; ++round) {
    auto damaged = clean;
    for (int i = 0; i < 20; ++i) {
      damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
    }
    const auto decoded = decode_oem7(damaged, 1 + random() % 500);
    const auto& framer = decoded.counters.framer;
    REQUIRE(framer.messages < 60);
    REQUIRE(framer.bad_checksums + framer.bad_headers + framer.incomplete + framer.bytes_skipped >
            0);
  }
}

TEST_CASE("Random bytes, and syncs that claim the longest message, end and are counted") {
  std::mt19937 random(7);
  auto bytes = random_bytes(&random, 300'000);
  for (std::size_t i = 0; i + 12 < bytes.size(); i += 12) {
    const std::uint8_t head[] = {0xAA, 0x44, 0x12, 28, 43, 0, 0, 0, 0x00, 0x40};
    std::copy(std::begin(head), std::end(head), bytes.begin() + static_cast<std::ptrdiff_t>(i));
  }
  const auto decoded = decode_oem7(bytes, 100);
  CHECK(decoded.counters.framer.messages == 0);
  CHECK(decoded.counters.framer.bytes_skipped == bytes.size());
  CHECK(decoded.counters.framer.bad_checksums > 10'000);
}

TEST_CASE("Text between messages is skipped and told") {
  if (!test::have_shared_data(test::kPositions)) return;
  const auto decoded = decode_oem7(test::stream_bytes(test::shared_data(test::kPositions)));
  CHECK(decoded.counters.framer.messages == 26);
  CHECK(decoded.counters.framer.bytes_skipped == 104);
}

TEST_CASE("A file gives its outputs one after the other; one that cannot be read is told") {
  if (!test::have_shared_data(test::kOemv)) return;
  Oem7FileReader reader(test::shared_data(test::kOemv));
  std::size_t epochs = 0, ephemerides = 0;
  for (Oem7Output output; reader.next(&output);) {
    epochs += std::holds_alternative<RawEpoch>(output);
    ephemerides += std::holds_alternative<Ephemeris>(output);
  }
  CHECK(epochs == 46);
  CHECK(ephemerides == reader.counters().ephemerides.ephemerides);
  CHECK(ephemerides > 5);
  const test::TemporaryFile place("nothing", "");
  CHECK_THROWS_AS(Oem7FileReader(place.beside("missing.gps")), FileError);
  CHECK_THROWS_AS(Oem7FileReader("/"), FileError);
}

}  // namespace leonav
