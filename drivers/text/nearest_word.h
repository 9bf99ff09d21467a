// This unit finds the nearest of a list of words, for "did you mean" in error messages.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// Returns the candidate with the fewest single-letter edits (Levenshtein) to `word`, or nullopt if
// even that one is no plausible typing error (more than half of the letters differ).
std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& candidates);

}  // namespace leonav
