#include "drivers/text/byte_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "drivers/text/parse.h"

namespace leonav {

ByteFile::ByteFile(const std::string& path, const std::string& what) : path_(path) {
  if (std::filesystem::is_directory(path)) {
    throw FileError(path, 0, "is a directory; name a file of " + what);
  }
  errno = 0;
  file_.open(path, std::ios::binary);
  if (!file_) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path and the permissions");
  }
}

std::span<const std::uint8_t> ByteFile::next() {
  if (!file_) return {};
  file_.read(chunk_.data(), chunk_.size());
  if (file_.bad()) throw FileError(path_, 0, "cannot be read to its end; check the disk");
  return {reinterpret_cast<const std::uint8_t*>(chunk_.data()),
          static_cast<std::size_t>(file_.gcount())};
}

}  // namespace leonav
