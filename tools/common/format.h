// This unit turns numbers into text for tables and JSON.
#pragma once
#include <string>

namespace leonav {

// Formats like printf; the result is cut after 511 bytes.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

// Returns `text` as a JSON string with its quotation marks.
std::string json_string(const std::string& text);

// Returns a JSON number; null for NaN and infinity, which JSON does not have.
std::string json_number(double value, int decimals);

}  // namespace leonav
