// This unit reads a text file line by line, with one step back.
#pragma once
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "drivers/text/parse.h"

namespace leonav {

// The reader counts lines and strips LF and CR LF. It refuses a compressed file, naming the program
// that unpacks it, and a line that is too long.
class LineReader {
 public:
  static constexpr std::size_t kMaxLineLength = 65'536;

  // Throws FileError if the file is absent, a directory, unreadable, or begins like a compressed
  // one.
  explicit LineReader(const std::string& path);

  // Reads the next line, which is valid until the next call; returns false at the end of the file.
  // A last line without a line feed counts. Throws FileError if the line is too long or reading
  // fails.
  bool next(std::string_view& line);
  // Makes next() return the last line again.
  void step_back() { stepped_back_ = true; }

  const std::string& path() const { return path_; }
  long line_number() const { return line_number_; }  // of the last line read, from 1

  // Throws FileError for the last line read.
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
