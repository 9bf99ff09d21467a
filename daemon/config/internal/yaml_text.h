// These functions write values as YAML text that is read back as the same bits.
#pragma once
#include <string>
#include <vector>

namespace leonav {

// Returns the shortest decimal of exactly this number.
std::string number_text(double number);

// Returns the shortest decimal whose product with `unit` is exactly `value`; if there is none, the
// shortest one of the quotient.
std::string number_text(double value, double unit);

// Returns the text in double quotes, with escapes.
std::string quoted_text(const std::string& text);

// Returns the text as it is, or in double quotes if YAML would read it as another type.
std::string plain_text(const std::string& text);

// Returns "[a, b]", each as plain_text().
std::string list_text(const std::vector<std::string>& elements);

// Returns "a, b or c".
std::string alternatives(const std::vector<std::string>& words);

}  // namespace leonav
