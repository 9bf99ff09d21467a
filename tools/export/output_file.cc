#include "tools/export/output_file.h"

#include <cstdio>
#include <filesystem>

#include "drivers/text/parse.h"

namespace leonav {

namespace {

constexpr int kMostNames = 1000;

// Creates a file of this name, unless there is one.
bool create(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wbx");
  if (file == nullptr) return false;
  std::fclose(file);
  return true;
}

// A file that is there may be the user's own, and is left alone.
std::string new_part_file(const std::string& path) {
  const std::string first = path + ".part";
  std::string name = first;
  std::error_code ignored;
  for (int i = 1; !create(name); ++i) {
    const auto status = std::filesystem::symlink_status(name, ignored);
    if (!std::filesystem::exists(status) || i > kMostNames) {
      throw FileError(name, 0, "cannot be created; check the folder");
    }
    name = first + "." + std::to_string(i);
  }
  return name;
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  std::error_code error;
  if (std::filesystem::exists(path_, error) && !std::filesystem::is_regular_file(path_, error)) {
    throw FileError(path_, 0, "is no regular file; give another name with --out");
  }
  part_path_ = new_part_file(path_);
  stream_.open(part_path_, std::ios::binary | std::ios::trunc);
  if (!stream_) throw FileError(part_path_, 0, "cannot be created; check the folder");
}

OutputFile::~OutputFile() {
  if (part_path_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(part_path_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  size_ += bytes.size();
}

void OutputFile::commit() {
  stream_.close();
  if (!stream_) throw FileError(part_path_, 0, "could not be written to the end; check the space");
  std::error_code error;
  std::filesystem::rename(part_path_, path_, error);
  if (error) throw FileError(path_, 0, "cannot be written: " + error.message());
  part_path_.clear();
}

}  // namespace leonav
