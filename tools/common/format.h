// Text of numbers for tables and JSON.
#pragma once
#include <string>

namespace leonav {

// As printf; the result is cut after 511 bytes.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

// With its quotation marks.
std::string json_string(const std::string& text);

// JSON knows neither NaN nor infinity: null.
std::string json_number(double value, int decimals);

}  // namespace leonav
