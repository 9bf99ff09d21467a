// The lines of a text file, with one step back.
#pragma once
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "drivers/text/parse.h"

namespace leonav {

// Counts lines, strips LF and CR LF, refuses what is no text: a compressed file (naming what
// unpacks it), a line that is too long.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineLength = 65'536;

  // Throws FileError if the file is absent, a directory, unreadable or begins like a compressed
  // one.
  explicit LineReader(const std::string& path);

  // The next line, valid until the next call; false at the end of the file. A last line without a
  // line feed counts. Throws FileError if the line is too long or reading fails.
  bool next(std::string_view& line);
  // next() gives the line last returned again.
  void step_back() { stepped_back_ = true; }

  const std::string& path() const { return path_; }
  long line_number() const { return line_number_; }  // of the line last read, from 1

  // Throws FileError for the line last read.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void refuse_compressed();

  std::string path_;
  std::ifstream stream_;
  std::string line_;
  long line_number_ = 0;
  bool stepped_back_ = false;
};

}  // namespace leonav
