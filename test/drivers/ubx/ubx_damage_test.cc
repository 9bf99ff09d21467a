// Damaged streams: nothing crashes, damage is counted, undamaged messages decode to the same.
#include <algorithm>
#include <set>
#include <tuple>

#include "drivers/ubx/ubx_file_reader.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"

namespace leonav {
namespace {

bool same_bits(double a, double b) { return a == b || (a != a && b != b); }

// Loss of lock depends on the epoch before, which may be lost: it is left out.
bool same(const RawEpoch& a, const RawEpoch& b) {
  return a.time == b.time &&
         std::equal(a.observations.begin(), a.observations.end(), b.observations.begin(),
                    b.observations.end(), [](const auto& x, const auto& y) {
                      return x.satellite == y.satellite && x.code == y.code &&
                             same_bits(x.pseudorange_m, y.pseudorange_m) &&
                             same_bits(x.carrier_cycles, y.carrier_cycles) &&
                             same_bits(x.doppler_hz, y.doppler_hz) &&
                             same_bits(x.cn0_dbhz, y.cn0_dbhz);
                    });
}

// First byte and length of each framed message, found by walking the clean stream.
struct Extent {
  std::size_t first, size;
  bool is_rawx;
};
std::vector<Extent> extents(const std::vector<std::uint8_t>& bytes) {
  std::vector<Extent> found;
  for (std::size_t i = 0; i + 8 <= bytes.size();) {
    if (bytes[i] != 0xB5 || bytes[i + 1] != 0x62) {
      ++i;
      continue;
    }
    const std::size_t size = 8u + bytes[i + 4] + 256u * bytes[i + 5];
    found.push_back({i, size, bytes[i + 2] == 0x02 && bytes[i + 3] == 0x15});
    i += size;
  }
  return found;
}

}  // namespace

TEST_CASE("Chunks of any size give the same outputs") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  auto bytes = test::read_bytes(test::shared_data(test::kWalkUbx));
  bytes.resize(200'000);
  const auto whole = test::decode_ubx(bytes, bytes.size());
  REQUIRE(whole.epochs.size() > 50);
  for (const std::size_t chunk : {1, 7, 4096}) {
    const auto parts = test::decode_ubx(bytes, chunk);
    REQUIRE(parts.epochs.size() == whole.epochs.size());
    CHECK(parts.ephemerides.size() == whole.ephemerides.size());
    CHECK(parts.counters.framer.bytes_skipped == whole.counters.framer.bytes_skipped);
    CHECK(std::equal(parts.epochs.begin(), parts.epochs.end(), whole.epochs.begin(), same));
  }
}

TEST_CASE("A flipped bit costs the message it is in and no other") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const auto clean = test::read_bytes(test::shared_data(test::kWalkUbx));
  const auto messages = extents(clean);
  REQUIRE(messages.size() == 3400);
  const auto reference = test::decode_ubx(clean);
  for (const std::size_t step : {997u, 5003u, 40009u}) {
    auto damaged = clean;
    for (std::size_t i = step / 2; i < damaged.size(); i += step) {
      damaged[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
    }
    const auto decoded = test::decode_ubx(damaged);
    std::size_t untouched = 0, untouched_rawx = 0, next_epoch = 0, rawx = 0;
    std::vector<std::size_t> expected;  // indices of the undamaged epochs
    for (const Extent& m : messages) {
      const bool is_whole = std::equal(clean.begin() + m.first, clean.begin() + m.first + m.size,
                                       damaged.begin() + m.first);
      untouched += is_whole;
      if (m.is_rawx && is_whole) expected.push_back(rawx);
      untouched_rawx += m.is_rawx && is_whole;
      rawx += m.is_rawx;
    }
    CAPTURE(step);
    CHECK(decoded.counters.framer.messages == untouched);
    REQUIRE(decoded.epochs.size() == untouched_rawx);
    for (const std::size_t k : expected) {
      REQUIRE(same(decoded.epochs[next_epoch++], reference.epochs[k]));
    }
    const UbxFramerCounters& c = decoded.counters.framer;
    CHECK(c.bad_checksums + c.oversize > 0);
    CHECK(c.bytes_skipped > reference.counters.framer.bytes_skipped);
  }
}

TEST_CASE("A false start of a message at the end of the stream swallows nothing") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  auto bytes = test::read_bytes(test::shared_data(test::kWalkUbx));
  bytes.resize(20'000);
  const auto before = test::decode_ubx(bytes);
  // Claims 4096 bytes, more than follow; what follows is the recording's first half again.
  std::vector<std::uint8_t> stream = {0xB5, 0x62, 0x02, 0x15, 0x00, 0x10};
  stream.insert(stream.end(), bytes.begin(), bytes.begin() + 3000);
  const auto whole = test::decode_ubx(std::span(bytes).first(3000));
  const auto held = test::decode_ubx(stream);
  REQUIRE(whole.counters.framer.messages > 0);
  CHECK(held.counters.framer.messages == whole.counters.framer.messages);
  CHECK(held.counters.framer.bad_checksums >= 1);
  CHECK(before.epochs.size() > whole.epochs.size());
}

TEST_CASE("A file that is absent or a directory is an error that names it") {
  CHECK_THROWS_WITH(UbxFileReader("no/such/file.ubx"), Catch::Contains("no/such/file.ubx"));
  CHECK_THROWS_WITH(UbxFileReader(LEONAV_SOURCE_DIR), Catch::Contains("directory"));
}

}  // namespace leonav
