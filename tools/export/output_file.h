// The OutputFile is complete or absent: it is written beside its name and renamed at the end.
#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace leonav {

class OutputFile {
 public:
  // Writes to `path` with ".part" appended, or ".part.1", ".part.2", ... where files have these
  // names. Throws FileError if that file cannot be created, or if `path` is there and no regular
  // file.
  explicit OutputFile(const std::string& path);
  ~OutputFile();  // removes the part file unless commit() was called
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  std::uint64_t size() const { return size_; }  // bytes written so far
  // Gives the file its name. Throws FileError if anything could not be written.
  void commit();

 private:
  std::string path_, part_path_;
  std::ofstream stream_;
  std::uint64_t size_ = 0;
};

}  // namespace leonav
