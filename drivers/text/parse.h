// Fixed-column and comma-separated text with errors that name file and line.
#pragma once
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// Thrown by every file reader: what() is "FILE:LINE: what is wrong; what to do", or
// "FILE: ..." where no line is to blame (line 0).
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& file, long line, const std::string& message);
};

// `text` without blanks and tabs at its ends.
std::string_view trim(std::string_view text);

// Columns [first, first + width) of a fixed-column line, first counted from 0; what lies beyond the
// end of the line is missing, so the result may be shorter or empty.
std::string_view columns(std::string_view line, std::size_t first, std::size_t width);

// A finite decimal number that fills `text` but for blanks around it. Fortran's exponent letter D
// counts as E. nullopt for an empty field, trailing characters, "nan", "inf", overflow and hex.
std::optional<double> parse_double(std::string_view text);
// A decimal integer that fills `text` but for blanks around it.
std::optional<int> parse_int(std::string_view text);

// Splits at every comma, without quoting; n commas give n + 1 trimmed fields. `fields` views
// `line`.
void split_csv(std::string_view line, std::vector<std::string_view>& fields);

}  // namespace leonav
