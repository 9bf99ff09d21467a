// The lines of a RINEX file, with one step back.
#pragma once
#include <string>
#include <string_view>

#include "drivers/text/parse.h"

namespace leonav {

class LineSource {
 public:
  // Throws FileError if the file cannot be opened or begins like a compressed one.
  explicit LineSource(const std::string& path);

  bool next(std::string_view& line);          // as LineReader::next
  void step_back() { stepped_back_ = true; }  // next() gives the same line again
  long number() const { return reader_.line_number(); }
  const std::string& path() const { return reader_.path(); }

 private:
  LineReader reader_;
  std::string_view line_;
  bool stepped_back_ = false;
};

}  // namespace leonav
