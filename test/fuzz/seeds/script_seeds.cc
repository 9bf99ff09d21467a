#include <random>

#include "test/fuzz/seeds/seed_writer.h"
#include "test/fuzz/sequencer_script.h"

namespace leonav::test {

// Each action alone between two seconds of good input, and random ones.
void write_script_seeds(SeedWriter* writer) {
  for (std::size_t action = 0; action < kScriptActions; ++action) {
    Seed seed;
    seed.byte(0).byte(0).byte(0).byte(1);  // the configuration; drive
    seed.byte(action).byte(20).byte(23).byte(16).byte(5).byte(0).byte(1);
    writer->write("sequencer", "action_" + std::to_string(action), seed);
  }
  std::mt19937 dice(1);
  for (int number = 0; number < 24; ++number) {
    Seed seed;
    for (int k = 0; k < 60; ++k) seed.byte(dice());
    writer->write("sequencer", "random_" + std::to_string(number), seed);
  }
}

}  // namespace leonav::test
