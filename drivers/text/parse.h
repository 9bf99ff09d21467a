// This unit parses fixed-column and comma-separated text and reports errors with file and line.
#pragma once
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// Every file reader throws this error. what() is "FILE:LINE: what is wrong; what to do", or "FILE:
// ..." where the error belongs to no line (line 0).
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& file, long line, const std::string& message);
};

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Returns `text` without blanks and tabs at its ends.
std::string_view trim(std::string_view text);

// Returns columns [first, first + width) of a fixed-column line, with `first` counted from 0. The
// result is shorter, or empty, where the line ends before.
std::string_view columns(std::string_view line, std::size_t first, std::size_t width);

// Parses a finite decimal number that fills `text` except for blanks around it. Fortran's exponent
// letter D counts as E. Returns nullopt for an empty field, trailing characters, "nan", "inf",
// overflow and hex.
std::optional<double> parse_double(std::string_view text);
// Parses a decimal integer that fills `text` except for blanks around it.
std::optional<int> parse_int(std::string_view text);

// Splits at every comma, without quoting; n commas give n + 1 trimmed fields. `fields` point into
// `line`.
void split_csv(std::string_view line, std::vector<std::string_view>& fields);

}  // namespace leonav
