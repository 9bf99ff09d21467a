#include "tools/common/format.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace leonav {

std::string format(const char* pattern, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(line, sizeof line, pattern, arguments);
  va_end(arguments);
  return line;
}

std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      out += format("\\u%04x", c);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json_number(double value, int decimals) {
  return std::isfinite(value) ? format("%.*f", decimals, value) : "null";
}

}  // namespace leonav
