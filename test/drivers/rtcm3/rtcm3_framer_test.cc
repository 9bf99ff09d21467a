// The framer on recorded and damaged bytes: nothing is lost but what is damaged.
#include "drivers/rtcm3/rtcm3_framer.h"

#include <random>

#include "rtcm3_streams.h"
#include "support/catch.h"

namespace leonav {
namespace {

std::vector<std::uint16_t> types_of(std::span<const std::uint8_t> bytes, std::size_t chunk,
                                    Rtcm3FramerCounters* counters) {
  Rtcm3Framer framer;
  Rtcm3Frame frame;
  std::vector<std::uint16_t> types;
  const auto drain = [&] {
    while (framer.next(&frame)) types.push_back(frame.type);
  };
  while (!bytes.empty()) {
    std::span<const std::uint8_t> part = bytes.first(std::min(chunk, bytes.size()));
    bytes = bytes.subspan(part.size());
    while (!part.empty()) {
      part = part.subspan(framer.append(part));
      drain();
    }
  }
  framer.finish();
  drain();
  *counters = framer.counters();
  return types;
}

}  // namespace

TEST_CASE("The checksum is CRC-24Q, and that of a piece follows from those around it") {
  const std::string text = "123456789";
  std::uint32_t crc = 0;
  for (const char c : text) crc = crc24q_next(crc, static_cast<std::uint8_t>(c));
  CHECK(crc == 0xCDE703);  // the published check value
  // The product with x^8 is a byte of zeros more.
  const std::uint32_t x8 = crc24q_next(1, 0);
  CHECK(crc24q_product(crc, x8) == crc24q_next(crc, 0));
  CHECK(crc24q_product(x8, crc) == crc24q_next(crc, 0));
}

TEST_CASE("Chunks of any size give the same frames, and no byte is unaccounted for") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kGmsd7));
  Rtcm3FramerCounters whole_counters;
  const auto whole = types_of(bytes, bytes.size(), &whole_counters);
  REQUIRE(whole.size() == 257u * 4 + 15 + 16 + 3 * 28);
  // The recording ends within a frame.
  std::size_t framed_bytes = 0;
  for (const auto& extent : test::frame_extents(bytes)) framed_bytes += extent.size;
  CHECK(whole_counters.bytes_skipped == bytes.size() - framed_bytes);
  for (const std::size_t chunk : {1u, 7u, 1029u, 4096u}) {
    Rtcm3FramerCounters counters;
    CHECK(types_of(bytes, chunk, &counters) == whole);
    CHECK(counters.bytes_skipped == whole_counters.bytes_skipped);
    CHECK(counters.bad_checksums == whole_counters.bad_checksums);
  }
}

TEST_CASE("A flipped bit costs the frame it is in and no other") {
  if (!test::have_shared_data(test::kGmsd7)) return;
  const auto clean = test::stream_bytes(test::shared_data(test::kGmsd7));
  const auto extents = test::frame_extents(clean);
  for (const std::size_t step : {997u, 5003u, 40009u}) {
    auto damaged = clean;
    for (std::size_t i = step / 2; i < damaged.size(); i += step) {
      damaged[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
    }
    std::vector<std::uint16_t> expected;
    for (const auto& e : extents) {
      const auto first = static_cast<std::ptrdiff_t>(e.first);
      const auto size = static_cast<std::ptrdiff_t>(e.size);
      if (std::equal(clean.begin() + first, clean.begin() + first + size,
                     damaged.begin() + first)) {
        expected.push_back(e.type);
      }
    }
    Rtcm3FramerCounters counters;
    CAPTURE(step);
    CHECK(types_of(damaged, 4096, &counters) == expected);
    CHECK(counters.bad_checksums > 0);
    CHECK(counters.frames == expected.size());
  }
}

TEST_CASE("A damaged length holds back no frame behind it") {
  Rtcm3Framer framer;
  Rtcm3Frame frame;
  std::size_t found = 0;
  for (std::uint8_t k = 0; k < 6; ++k) {
    const std::vector<std::uint8_t> message = {0x3F, 0xF0, k, 0, 0, 0};  // of the type 1023
    auto bytes = test::framed(message);
    if (k == 2) bytes[1] ^= 0x03;  // 768 bytes more
    REQUIRE(framer.append(bytes) == bytes.size());
    while (framer.next(&frame)) {
      CHECK(frame.type == 1023);
      CHECK(frame.message[2] == k);
      ++found;
    }
    // Each frame comes out with its own last byte.
    REQUIRE(found == (k < 2 ? k + 1U : k));
  }
  CHECK(framer.counters().bytes_skipped == 12);
  CHECK(framer.counters().bad_checksums == 1);
}

TEST_CASE("A false preamble swallows nothing, in the stream or at its end") {
  if (!test::have_shared_data(test::kMixed)) return;
  const auto bytes = test::stream_bytes(test::shared_data(test::kMixed));
  Rtcm3FramerCounters counters;
  const auto alone = types_of(bytes, 64, &counters);
  REQUIRE(alone.size() == 7);
  const std::uint64_t foreign = counters.bytes_skipped;  // of other protocols, between the frames
  // It claims 1023 bytes, which reach beyond the end of what follows.
  std::vector<std::uint8_t> stream = {0xD3, 0x03, 0xFF};
  test::append(&stream, bytes);
  CHECK(types_of(stream, 64, &counters) == alone);
  CHECK(counters.bytes_skipped == foreign + 3);
  CHECK(counters.incomplete + counters.bad_checksums == 1);
  // Frames without a message are filling; they interrupt nothing.
  stream = test::framed({});
  test::append(&stream, bytes);
  CHECK(types_of(stream, 64, &counters) == alone);
  CHECK(counters.too_short == 1);
  CHECK(counters.bytes_skipped == foreign);
}

TEST_CASE("Random bytes, also full of preambles, give nothing and are all counted") {
  std::mt19937 random(20'250'101);
  for (const bool many_preambles : {false, true}) {
    std::vector<std::uint8_t> bytes(300'000);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(random());
      if (many_preambles && random() % 3 == 0) byte = 0xD3;
      if (many_preambles && random() % 3 == 0) byte = 0x03;
    }
    Rtcm3FramerCounters counters;
    CHECK(types_of(bytes, 1000, &counters).empty());
    CHECK(counters.bytes_skipped == bytes.size());
    CHECK(counters.bad_checksums > 0);
  }
}

}  // namespace leonav
