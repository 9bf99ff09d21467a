// A fuzz target takes any bytes from outside through one reader of leonav.
#pragma once
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace leonav::test {

using FuzzBytes = std::span<const std::uint8_t>;

// A target throws it where a result cannot be right; what() says which. Every other exception that
// leaves a target is a finding as well: targets catch the errors that a reader documents.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

inline void expect(bool holds, const char* what) {
  if (!holds) throw Finding(what);
}

struct FuzzTarget {
  std::string_view name;  // of its folder in test/fuzz/corpus
  void (*run)(FuzzBytes bytes) = nullptr;
};

// All targets, in the order in which they run.
const std::vector<FuzzTarget>& fuzz_targets();
// Returns the target with this name, or nullptr.
const FuzzTarget* find_fuzz_target(std::string_view name);

// Returns whether an input gets the whole of a check of which most inputs get the cheaper part: one
// in `one_in` does, by a hash that its bytes do not show, or every one.
bool is_chosen(FuzzBytes bytes, std::uint64_t one_in);
void choose_every_input(bool is_on);

}  // namespace leonav::test
