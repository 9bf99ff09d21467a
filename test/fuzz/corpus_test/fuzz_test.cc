// Every target over its corpus and over mutations of it, the same ones each time. What finds new
// inputs is libFuzzer (tools/validate fuzz); what it has found stays in the corpus.
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "mutator.h"
#include "support/catch.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/fuzz_target.h"
#include "test/fuzz/good_input.h"
#include "test/fuzz/sequencer_script.h"

namespace leonav::test {
namespace {

void run(const FuzzTarget& target, const Bytes& bytes) {
  try {
    target.run(bytes);
  } catch (const std::exception& error) {
    const std::string kept = std::string(target.name) + ".finding";
    std::ofstream(kept, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    FAIL(target.name << ": " << error.what() << "\nThe input was written to " << kept);
  }
}

void run_seeds(const FuzzTarget& target, const std::vector<Seed>& seeds) {
  REQUIRE_FALSE(seeds.empty());
  for (const Seed& seed : seeds) {
    INFO("seed " << seed.name);
    run(target, seed.bytes);
  }
}

void run_all(const FuzzTarget& target, std::size_t mutations) {
  const std::vector<Seed> seeds = corpus_of(target.name);
  choose_every_input(false);  // as libFuzzer does
  run_seeds(target, seeds);
  choose_every_input(true);
  run_seeds(target, seeds);
  run(target, {});
  Mutator mutator(&seeds);
  for (std::size_t i = 0; i < mutations; ++i) {
    INFO("mutation " << i);
    run(target, mutator.next());
  }
}

TEST_CASE("One input in four is chosen where one in four is to be", "[fuzz]") {
  choose_every_input(false);
  int chosen = 0;
  for (std::uint8_t first = 0; first < 200; ++first) {
    const std::array<std::uint8_t, 2> bytes = {first, 1};
    chosen += is_chosen(bytes, 4);
  }
  CHECK(chosen > 30);
  CHECK(chosen < 70);
  choose_every_input(true);
  CHECK(is_chosen(Bytes(), 1'000'000));
}

TEST_CASE("No target is stopped by its corpus, nor by a thousand mutations of it", "[fuzz]") {
  for (const FuzzTarget& target : fuzz_targets()) {
    INFO("target " << target.name);
    run_all(target, target.name == "sequencer" ? 2000 : 1000);
  }
}

TEST_CASE("Targets have names of their own", "[fuzz]") {
  for (const FuzzTarget& target : fuzz_targets()) {
    CHECK(find_fuzz_target(target.name) == &target);
  }
  CHECK(find_fuzz_target("none") == nullptr);
}

TEST_CASE("A Sequencer that takes no epochs is found to be a dead end", "[fuzz]") {
  // Epochs and samples never meet: the configured offset moves the samples by a day.
  NavigatorConfig config;
  config.imu_time_offset_s = 86'400.0;
  CheckedStages stages;
  Sequencer sequencer(config, &stages);
  GoodInput good{GpsTime::from_week_and_tow(2200, 0.0)};
  CHECK_THROWS_AS(require_recovery(config, &sequencer, &stages, good), Finding);
  good.base = good.base.plus_seconds(1000.0);
  good.stops_early = true;
  CHECK_THROWS_AS(require_recovery(config, &sequencer, &stages, good), Finding);
}

TEST_CASE("A script ends once it has enough inputs", "[fuzz]") {
  const Bytes drives(1000, 0xF0);  // each drives for one second: 0xF0 % 4 is 0
  CHECK(script_from(drives).steps.size() == 10);
  const Bytes commands(1000, 0xFA);
  CHECK(script_from(commands).steps.size() == 200);
}

}  // namespace
}  // namespace leonav::test
