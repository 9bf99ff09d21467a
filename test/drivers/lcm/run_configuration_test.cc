#include "drivers/lcm/run_configuration.h"

#include <vector>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("A run's configuration survives the journal; damage is refused") {
  const RunConfiguration written{
      "leonavd 1.2", "car.yaml", "gnss:\n  x: 1\n", {"a.b=1", "c=[d, e]"}};
  const std::vector<std::uint8_t> bytes = encode(written);
  const auto read = decode_run_configuration(bytes);
  REQUIRE(read.has_value());
  CHECK(read->program == written.program);
  CHECK(read->name == written.name);
  CHECK(read->text == written.text);
  CHECK(read->overrides == written.overrides);

  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_FALSE(decode_run_configuration(ByteSpan(bytes).first(size)).has_value());
  }
  // Every length of a string, replaced by what would make a trusting reader overrun.
  std::size_t at = 28;
  for (int string = 0; string < 4; ++string) {
    const std::size_t length = bytes[at + 3];
    for (const std::uint8_t first : {0x7f, 0x80, 0xff, 0x01}) {
      std::vector<std::uint8_t> damaged = bytes;
      damaged[at] = first;
      CHECK_FALSE(decode_run_configuration(damaged).has_value());
    }
    std::vector<std::uint8_t> damaged = bytes;
    damaged[at + 3] = 0;
    CHECK_FALSE(decode_run_configuration(damaged).has_value());
    at += 4 + length;
  }
  auto other_schema = bytes;
  other_schema[27] = 9;
  CHECK_FALSE(decode_run_configuration(other_schema).has_value());
}

TEST_CASE("the end of a journal is read back, and refused where damaged") {
  const auto bytes = leonav::encode_journal_end(123'456'789'012);
  CHECK(leonav::decode_journal_end(bytes) == 123'456'789'012);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_FALSE(leonav::decode_journal_end(ByteSpan(bytes).first(size)).has_value());
  }
  auto other_schema = bytes;
  other_schema[27] = 9;
  CHECK_FALSE(leonav::decode_journal_end(other_schema).has_value());
}
