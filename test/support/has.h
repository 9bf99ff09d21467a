// Whether a text has certain words.
#pragma once
#include <string>

namespace leonav::test {

inline bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace leonav::test
