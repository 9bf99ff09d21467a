// A Sentence puts fields together to one line of NMEA 0183, with checksum and line end.
#pragma once
#include <string>
#include <string_view>

namespace leonav {

// Returns the exclusive or of all characters between '$' and '*'. Source: NMEA 0183 v4.10, 5.3.1.
unsigned nmea_checksum(std::string_view body);

class Sentence {
 public:
  // `address` is talker and formatter, for instance "GNGGA".
  explicit Sentence(std::string_view address) : body_(address) {}

  // Appends one field; an empty one says that the value is not known.
  Sentence& field(std::string_view text) {
    body_ += ',';
    body_ += text;
    return *this;
  }
  // Returns the line with '$', '*', the checksum in two hexadecimal digits, and CR LF.
  std::string line() const;

 private:
  std::string body_;
};

// Returns a TXT sentence with a warning (type 01) in plain words. Characters that the standard
// reserves are replaced by blanks. Source: NMEA 0183 v4.10, TXT.
std::string text_sentence(std::string_view text);

}  // namespace leonav
