// Values as YAML text that is read back as the same bits.
#pragma once
#include <string>
#include <vector>

namespace leonav {

// The shortest decimal of exactly this number.
std::string number_text(double number);

// The shortest decimal whose product with `unit` is exactly `value`; where there is none, the
// shortest of the quotient.
std::string number_text(double value, double unit);

// In double quotes, with escapes.
std::string quoted_text(const std::string& text);

// As it is, or in double quotes where YAML would read it in its own way.
std::string plain_text(const std::string& text);

// "[a, b]", each as plain_text().
std::string list_text(const std::vector<std::string>& elements);

// "a, b or c".
std::string alternatives(const std::vector<std::string>& words);

}  // namespace leonav
