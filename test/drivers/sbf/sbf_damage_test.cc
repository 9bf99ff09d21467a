// Damaged, cut and random streams: nothing crashes, every loss is counted; and whole files.
#include <algorithm>
#include <random>

#include "drivers/sbf/sbf_file_reader.h"
#include "drivers/text/parse.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::decode_sbf;

constexpr std::uint16_t kUsed[] = {4002, 4017, 4022, 4023, 4027, 4047, 4050, 4081, 5891, 5893};

std::vector<std::uint8_t> random_bytes(std::mt19937* random, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>((*random)());
  return bytes;
}

// A MeasEpoch whose lengths and counts are right and whose values are not.
std::vector<std::uint8_t> random_epoch(std::mt19937* random) {
  const std::size_t masters = (*random)() % 5;
  std::vector<std::uint8_t> payload = {static_cast<std::uint8_t>(masters), 20, 12, 0, 0, 0};
  for (std::size_t i = 0; i < masters; ++i) {
    auto master = random_bytes(random, 20);
    master[19] %= 4;
    const auto slaves = random_bytes(random, 12u * master[19]);
    payload.insert(payload.end(), master.begin(), master.end());
    payload.insert(payload.end(), slaves.begin(), slaves.end());
  }
  return payload;
}

// Blocks of every used kind with random contents.
std::vector<std::uint8_t> random_stream(int count) {
  std::mt19937 random(4711);
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < count; ++i) {
    const std::uint16_t number = kUsed[random() % std::size(kUsed)];
    const bool is_epoch = number == 4027 && random() % 2 == 0;
    const auto payload = is_epoch ? random_epoch(&random) : random_bytes(&random, random() % 300);
    const auto time = static_cast<std::uint32_t>(test::kTime_ms + 250 * i);
    const auto block = test::block_of({number, time}, payload);
    stream.insert(stream.end(), block.begin(), block.end());
  }
  return stream;
}

}  // namespace

TEST_CASE("Chunks of any size give the same outputs") {
  const auto bytes = random_stream(2'000);
  const auto whole = decode_sbf(bytes, bytes.size());
  REQUIRE(whole.epochs.size() > 10);
  for (const std::size_t chunk : {1u, 7u, 4096u}) {
    const auto parts = decode_sbf(bytes, chunk);
    REQUIRE(parts.epochs.size() == whole.epochs.size());
    CHECK(parts.rates.size() == whole.rates.size());
    CHECK(parts.counters.framer.blocks == 2'000);
    CHECK(std::equal(parts.epochs.begin(), parts.epochs.end(), whole.epochs.begin(),
                     test::same_epoch));
  }
}

TEST_CASE("Blocks of random contents with a good checksum do no harm") {
  const auto decoded = decode_sbf(random_stream(20'000), 1000);
  const SbfCounters& c = decoded.counters;
  CHECK(c.framer.blocks == 20'000);
  CHECK(c.framer.bytes_skipped == 0);
  CHECK(c.measurements.bad_length > 400);  // half of the MeasEpochs are well formed
  CHECK(c.measurements.scrambled > 100);
  CHECK(c.measurements.other_antennas > 100);
  CHECK(c.epochs.epochs > 50);
  CHECK(c.epochs.bad_value > 0);
  CHECK(c.raw.bad_length > 100);
  CHECK(c.raw.bad_satellite > 100);
  CHECK(c.navigation.bad_parity > 20);
  CHECK(c.decoded.bad_length > 0);
  CHECK(c.decoded.bad_satellite > 0);
  CHECK(c.imu.bad_length > 0);
  CHECK(c.navigation.ephemerides == 0);
  CHECK(decoded.ephemerides.empty());
}

TEST_CASE("A stream may end at every byte") {
  const auto stream = random_stream(40);
  for (std::size_t size = 0; size <= stream.size(); ++size) {
    const auto decoded = decode_sbf(std::span(stream).first(size));
    const auto& framer = decoded.counters.framer;
    REQUIRE(framer.blocks <= 40);
    REQUIRE((framer.blocks == 40) == (size == stream.size()));
  }
}

TEST_CASE("A damaged length holds back no block behind it") {
  const auto stream = random_stream(40);
  const auto blocks = test::block_extents(stream);
  auto damaged = stream;
  damaged[blocks[3].first + 6] = 0xFC, damaged[blocks[3].first + 7] = 0x3F;  // 16,380 bytes
  SbfDecoder decoder;
  test::SbfCollector collector;
  decoder.feed(damaged, &collector);
  CHECK(stream.size() < 16'380);
  CHECK(decoder.counters().framer.blocks == 39);  // before the end of the stream
  CHECK(decoder.counters().framer.bytes_skipped == blocks[3].size);
}

TEST_CASE("A flipped bit costs the block it is in and no other") {
  const auto clean = random_stream(2'000);
  const auto blocks = test::block_extents(clean);
  const auto reference = decode_sbf(clean);
  REQUIRE(blocks.size() == 2'000);
  for (const std::size_t step : {997u, 5003u, 40009u}) {
    auto damaged = clean;
    for (std::size_t i = step / 2; i < damaged.size(); i += step) {
      damaged[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
    }
    const auto untouched = std::count_if(blocks.begin(), blocks.end(), [&](const auto& b) {
      const auto first = clean.begin() + static_cast<std::ptrdiff_t>(b.first);
      return std::equal(first, first + static_cast<std::ptrdiff_t>(b.size),
                        damaged.begin() + static_cast<std::ptrdiff_t>(b.first));
    });
    const auto decoded = decode_sbf(damaged);
    CHECK(decoded.counters.framer.blocks == static_cast<std::uint64_t>(untouched));
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
    const auto decoded = decode_sbf(damaged, 1 + random() % 500);
    const auto& framer = decoded.counters.framer;
    REQUIRE(framer.blocks < 60);
    REQUIRE(framer.bytes_skipped > 0);
  }
}

TEST_CASE("Random bytes, and syncs that claim the longest block, end and are counted") {
  std::mt19937 random(7);
  auto bytes = random_bytes(&random, 300'000);
  for (std::size_t i = 0; i + 12 < bytes.size(); i += 12) {
    // 0x4000 is the longest length that is accepted.
    const std::uint8_t head[] = {'$', '@', 0, 0, 0xBB, 0x0F, 0x00, 0x40};
    std::copy(std::begin(head), std::end(head), bytes.begin() + static_cast<std::ptrdiff_t>(i));
  }
  const auto decoded = decode_sbf(bytes, 100);
  // A checksum of 16 bits fits by chance once in 65,536 times; here it does not.
  CHECK(decoded.counters.framer.blocks == 0);
  CHECK(decoded.counters.framer.bytes_skipped == bytes.size());
  CHECK(decoded.counters.framer.bad_checksums > 10'000);
}

TEST_CASE("Lengths that no block has are no blocks, and cost two bytes at most") {
  const auto good = test::epoch_block({{}});
  for (const unsigned size : {0u, 8u, 12u, 17u, 18u, 65'532u, 65'535u}) {
    test::Bytes stream;
    stream.u1('$').u1('@').u2(0).u2(4027).u2(size).join(good);
    const auto decoded = decode_sbf(stream.list);
    CAPTURE(size);
    CHECK(decoded.counters.framer.bad_lengths == 1);
    CHECK(decoded.epochs.size() == 1);
  }
}

TEST_CASE("NMEA and RTCM between blocks are skipped and told") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto decoded = test::decode_recorded(test::kMixed);
  CHECK(decoded.counters.framer.blocks == 2);
  CHECK(decoded.counters.framer.bytes_skipped == 297 - 96 - 44);
  CHECK(decoded.counters.framer.text_bytes > 100);
  CHECK(decoded.counters.unused.at(4007) == 1);
  CHECK(decoded.counters.unused.at(4052) == 1);
}

TEST_CASE("A recording without measurements frames to its last byte and gives nothing") {
  if (!test::have_shared_data(test::kX5Positions)) return;
  const auto decoded = test::decode_recorded(test::kX5Positions);
  CHECK(decoded.counters.framer.blocks == 232);
  CHECK(decoded.counters.framer.bytes_skipped == 0);
  CHECK(decoded.counters.unused.size() == 4);
  CHECK(decoded.epochs.empty());
}

TEST_CASE("A file gives its outputs one after the other; one that cannot be read is told") {
  test::Bytes stream;
  stream.join(test::epoch_block({{}})).join(test::epoch_block({{}}, test::kTime_ms + 1000));
  const test::TemporaryFile place("some.sbf", std::string(stream.list.begin(), stream.list.end()));
  SbfFileReader reader(place.path());
  std::size_t epochs = 0;
  for (SbfOutput output; reader.next(&output);) epochs += std::holds_alternative<RawEpoch>(output);
  CHECK(epochs == 2);
  CHECK(reader.counters().framer.blocks == 2);
  CHECK_THROWS_AS(SbfFileReader(place.beside("missing.sbf")), FileError);
  CHECK_THROWS_AS(SbfFileReader("/"), FileError);
}

}  // namespace leonav
