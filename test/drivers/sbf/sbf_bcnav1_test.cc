// B-CNAV1 in BDSRawB1C: subframes that a u-blox receiver has recorded, arranged as Septentrio
// arranges them by an encoder in Python, and frames that cannot be used.
#include <cstdlib>

#include "drivers/ubx/walk_recording.h"
#include "sbf_streams.h"
#include "support/catch.h"
#include "support/recorded/ephemeris_elements.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

using test::block_of;
using test::Bytes;
using test::decode_sbf;

struct BiasCollector : test::SbfCollector {
  void on_biases(const std::vector<SignalBias>& of_satellite) override {
    biases.insert(biases.end(), of_satellite.begin(), of_satellite.end());
  }
  std::vector<SignalBias> biases;
};

std::vector<std::uint8_t> frame_of(unsigned satellite, unsigned passed, std::uint32_t number) {
  Bytes b;
  b.u1(satellite).u1(passed).u1(1).u1(13).u1(0).u1(1);
  b.u4(number << 26);
  for (int i = 1; i < 57; ++i) b.u4(0);
  return block_of({4218}, b.list);
}

}  // namespace

TEST_CASE("Frames of B-CNAV1 give the sets and delays that a u-blox receiver's subframes give") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const test::TemporaryFile place("b1c.sbf", "");
  REQUIRE(std::system(("python3 '" LEONAV_SOURCE_DIR "/test/oracle/bcnav1.py' sbf '" +
                       test::shared_data(test::kWalkUbx) + "' >'" + place.path() + "'")
                          .c_str()) == 0);
  BiasCollector ours;
  SbfDecoder decoder;
  decoder.feed(test::stream_bytes(place.path()), &ours);
  decoder.finish(&ours);
  CHECK(decoder.counters().navigation.subframes == 51);
  CHECK(decoder.counters().navigation.bad_parity + decoder.counters().raw.wrong_satellite == 0);
  const auto walk = test::decode_walk();
  std::size_t same = 0;
  for (const Ephemeris& theirs : walk.ephemerides) {
    if (!is_for_corrections_alone(theirs)) continue;
    for (const Ephemeris& e : ours.ephemerides) {
      same += e.satellite == theirs.satellite && e.toe == theirs.toe && e.toc == theirs.toc &&
              e.issue == theirs.issue && e.a_dot == theirs.a_dot &&
              e.delta_n_dot == theirs.delta_n_dot &&
              test::elements_of(e) == test::elements_of(theirs);
    }
  }
  CHECK(same == 8);
  CHECK(ours.ephemerides.size() == 8);
  CHECK(ours.biases.size() == 8 * 4);
}

TEST_CASE("Frames of B-CNAV1 that cannot be used are counted by their reason") {
  std::vector<std::uint8_t> stream;
  for (const auto& block :
       {frame_of(161, 0, 21), frame_of(161, 1, 22), frame_of(161, 1, 21), frame_of(77, 1, 21)}) {
    stream.insert(stream.end(), block.begin(), block.end());
  }
  const SbfCounters c = decode_sbf(stream).counters;
  CHECK(c.raw.crc_failed == 1);
  CHECK(c.raw.wrong_satellite == 1);
  CHECK(c.raw.bad_satellite == 1);
  CHECK(c.navigation.bad_parity == 1);  // nothing but zeros
}

}  // namespace leonav
