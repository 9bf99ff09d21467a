// CNAV and B-CNAV2 in GPSRawL2C, GPSRawL5 and BDSRawB2a: messages that a u-blox receiver has
// recorded, arranged as Septentrio arranges them by an encoder in Python that pysbf2 agrees with,
// and blocks that cannot be used.
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "drivers/ubx/walk_recording.h"
#include "oracle_programs.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::block_of;
using test::Bytes;
using test::decode_sbf;

// Metres of each signal's delay, by satellite and signal.
using DelayTable = std::map<std::pair<std::string, std::string>, double>;

struct DelayCollector : test::SbfCollector {
  void on_biases(const std::vector<SignalBias>& of_satellite) override {
    for (const SignalBias& bias : of_satellite) {
      CHECK(bias.kind == BiasKind::kBroadcastCode);
      delays[{to_string(bias.satellite), to_string(bias.code)}] = bias.bias_m;
    }
  }
  DelayTable delays;
};

// What the oracle reads in the recording itself, without B-CNAV1, which has another block.
DelayTable delays_of(const std::string& recording) {
  const test::TemporaryFile lines("cnav.txt", "");
  REQUIRE(std::system(("python3 '" LEONAV_SOURCE_DIR "/test/oracle/cnav.py' '" + recording +
                       "' | awk '/^G/ || /5D/' >'" + lines.path() + "'")
                          .c_str()) == 0);
  DelayTable delays;
  for (const auto& words : test::words_of(lines.path())) {
    for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
      delays[{words[0], words[i]}] = std::stod(words[i + 1]);
    }
  }
  return delays;
}

std::vector<std::uint8_t> cnav_block(std::uint16_t number, unsigned satellite, unsigned passed,
                                     std::size_t words) {
  Bytes b;
  b.u1(satellite).u1(passed).u1(0).u1(3).u1(0).u1(1);
  for (std::size_t i = 0; i < words; ++i) b.u4(0);
  return block_of({number}, b.list);
}

}  // namespace

TEST_CASE(
    "Blocks with CNAV and B-CNAV2 give the delays that an oracle reads in the same messages") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const test::TemporaryFile place("cnav.sbf", "");
  REQUIRE(test::run(test::sbf_oracle() + "cnav '" + test::shared_data(test::kWalkUbx) + "' >'" +
                    place.path() + "'"));
  DelayCollector ours;
  SbfDecoder decoder;
  decoder.feed(test::stream_bytes(place.path()), &ours);
  decoder.finish(&ours);
  const SbfCounters c = decoder.counters();
  CHECK(c.framer.blocks == 40 + 108 + 364);
  CHECK(c.unused.empty());
  CHECK(c.navigation.bad_parity + c.navigation.wrong_satellite == 0);
  CHECK(c.navigation.subframes + c.navigation.other_message == 40 + 108 + 364);
  const DelayTable expected = delays_of(test::shared_data(test::kWalkUbx));
  CHECK(expected.size() > 30);
  REQUIRE(ours.delays.size() == expected.size());
  for (const auto& [key, metres] : expected) {
    CAPTURE(key.first, key.second);
    REQUIRE(ours.delays.count(key) == 1);
    CHECK(ours.delays.at(key) == Approx(metres).epsilon(1e-14).margin(1e-14));
  }
}

TEST_CASE("Blocks with CNAV and B-CNAV2 that cannot be used are counted by their reason") {
  std::vector<std::uint8_t> stream;
  for (const auto& block :
       {cnav_block(4018, 5, 0, 10), cnav_block(4019, 5, 1, 9), cnav_block(4219, 161, 1, 17),
        cnav_block(4018, 161, 1, 10), cnav_block(4219, 5, 1, 18), cnav_block(4018, 5, 1, 10),
        cnav_block(4019, 5, 1, 10), cnav_block(4219, 161, 1, 18)}) {
    stream.insert(stream.end(), block.begin(), block.end());
  }
  const SbfCounters c = decode_sbf(stream).counters;
  CHECK(c.raw.crc_failed == 1);
  CHECK(c.raw.bad_length == 2);
  CHECK(c.raw.bad_satellite == 2);
  // Nothing but zeros: no preamble of CNAV, no number of a satellite in B-CNAV2.
  CHECK(c.navigation.bad_parity == 2);
  CHECK(c.navigation.wrong_satellite == 1);
  CHECK(c.unused.empty());
}

}  // namespace leonav
