#include "tools/export/output_file.h"

#include <filesystem>

#include "drivers/text/parse.h"

namespace leonav {

OutputFile::OutputFile(const std::string& path) : path_(path), part_path_(path + ".part") {
  for (const std::string& one : {path_, part_path_}) {
    std::error_code error;
    if (std::filesystem::exists(one, error) && !std::filesystem::is_regular_file(one, error)) {
      throw FileError(one, 0, "is no regular file; give another name with --out");
    }
  }
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
