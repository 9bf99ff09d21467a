#include "mutator.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace leonav::test {

namespace fs = std::filesystem;

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

}  // namespace leonav::test
