#include "drivers/nmea/sentence.h"

#include <array>
#include <cstdio>

namespace leonav {

unsigned nmea_checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum;
}

std::string Sentence::line() const {
  std::array<char, 8> end;
  std::snprintf(end.data(), end.size(), "*%02X\r\n", nmea_checksum(body_));
  return "$" + body_ + end.data();
}

std::string text_sentence(std::string_view text) {
  // $GNTXT,01,01,01, and *HH with the line end leave 61 of 82 characters.
  std::string plain(text.substr(0, 61));
  for (char& c : plain) {
    const bool is_reserved = std::string_view("$*,!\\^~").find(c) != std::string_view::npos;
    if (is_reserved || c < ' ' || c > '~') c = ' ';
  }
  return Sentence("GNTXT").field("01").field("01").field("01").field(plain).line();
}

}  // namespace leonav
