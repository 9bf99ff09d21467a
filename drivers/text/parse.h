// Fixed-column and comma-separated text with errors that name file and line.
#pragma once
#include <stdexcept>
#include <string>

namespace leonav {

// Thrown by every file reader: what() is "FILE:LINE: what is wrong; what to do".
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& file, long line, const std::string& message);
};

}  // namespace leonav
