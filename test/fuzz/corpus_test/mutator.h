// Inputs for a target without libFuzzer: its corpus, and mutations of it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace leonav::test {

using Bytes = std::vector<std::uint8_t>;

struct Seed {
  std::string name;
  Bytes bytes;
};

// Returns the files of a target's corpus in the order of their names; empty: it has none.
std::vector<Seed> corpus_of(std::string_view target);

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

}  // namespace leonav::test
