// "Did you mean": the nearest of a list of words.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// The candidate with the fewest single-letter edits (Levenshtein) to `word`; nullopt if even that
// is no plausible slip of the pen (more than half of the letters differ).
std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& candidates);

}  // namespace leonav
