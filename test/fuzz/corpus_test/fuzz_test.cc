// Every target over its corpus and over mutations of it, the same ones each time. What finds new
// inputs is libFuzzer (tools/validate fuzz); what it has found stays in the corpus.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "support/catch.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/fuzz_target.h"
#include "test/fuzz/good_input.h"
#include "test/fuzz/sequencer_script.h"

namespace leonav::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

struct Seed {
  std::string name;
  Bytes bytes;
};

std::vector<Seed> corpus_of(std::string_view target) {
  std::vector<Seed> seeds;
  const fs::path folder = fs::path(LEONAV_SOURCE_DIR) / "test/fuzz/corpus" / target;
  if (!fs::is_directory(folder)) return seeds;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    seeds.push_back({entry.path().filename(), {std::istreambuf_iterator<char>(file), {}}});
  }
  std::sort(seeds.begin(), seeds.end(),
            [](const Seed& a, const Seed& b) { return a.name < b.name; });
  return seeds;
}

// Mutations of a corpus, by a generator that begins the same each time.
class Mutator {
 public:
  explicit Mutator(const std::vector<Seed>* seeds) : seeds_(seeds) {}

  Bytes next() {
    Bytes bytes = any_seed();
    for (std::size_t n = 1 + below(6); n > 0; --n) change(&bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : dice_() % limit; }
  const Bytes& any_seed() { return (*seeds_)[below(seeds_->size())].bytes; }
  static auto at(Bytes* bytes, std::size_t place) {
    return bytes->begin() + static_cast<std::ptrdiff_t>(place);
  }
  void change(Bytes* bytes);

  const std::vector<Seed>* seeds_;
  std::mt19937_64 dice_{1};
};

void Mutator::change(Bytes* bytes) {
  constexpr std::uint8_t kEdges[] = {0x00, 0x01, 0x7F, 0x80, 0xFF, '0', '9', '-', '.', '\n', ' '};
  const std::size_t size = bytes->size(), place = below(size), length = below(size - place) % 64;
  switch (below(8)) {
    case 0:  // a bit
      if (size > 0) (*bytes)[place] ^= static_cast<std::uint8_t>(1U << below(8));
      return;
    case 1:  // a byte at an edge
      if (size > 0) (*bytes)[place] = kEdges[below(std::size(kEdges))];
      return;
    case 2:  // any byte
      if (size > 0) (*bytes)[place] = static_cast<std::uint8_t>(dice_());
      return;
    case 3:  // less
      bytes->erase(at(bytes, place), at(bytes, place + length));
      return;
    case 4: {  // twice
      const Bytes part(at(bytes, place), at(bytes, place + length));
      bytes->insert(at(bytes, below(size + 1)), part.begin(), part.end());
      return;
    }
    case 5: {  // the beginning of one and the end of another
      const Bytes& other = any_seed();
      const std::size_t from = below(other.size() + 1);
      bytes->resize(place);
      bytes->insert(bytes->end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      return;
    }
    case 6:  // numbers at an edge
      for (std::size_t i = 0; i < std::min<std::size_t>(length, 8); ++i)
        (*bytes)[place + i] = kEdges[below(5)];
      return;
    default:  // cut off
      if (below(4) == 0) bytes->resize(place);
  }
}

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
