#include "daemon/checkpoint/internal/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <string_view>

namespace leonav {
namespace {

constexpr std::string_view kEnding = ".tmp";

using Path = std::array<char, PATH_MAX>;

std::string failure(std::string_view path, const char* what) {
  return std::string(path) + ": " + what + ": " + std::strerror(errno);
}

bool write_all(int descriptor, std::string_view text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t n = write(descriptor, text.data() + written, text.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    written += static_cast<std::size_t>(n);
  }
  return true;
}

// A new name is on the disk only once its folder is. Some file systems cannot: no harm.
void sync_folder_of(const std::string& path) {
  Path folder{'.'};
  const std::size_t end = path.rfind('/');
  if (end != path.npos) path.copy(folder.data(), std::clamp<std::size_t>(end, 1, PATH_MAX - 1));
  const int descriptor = open(folder.data(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

std::string replace_file(const std::string& path, std::string_view content) {
  Path beside{};
  if (path.size() + kEnding.size() >= beside.size()) {
    errno = ENAMETOOLONG;
    return failure(path, "cannot be made");
  }
  kEnding.copy(beside.data() + path.copy(beside.data(), path.size()), kEnding.size());
  const int descriptor =
      open(beside.data(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644);
  if (descriptor < 0) return failure(beside.data(), "cannot be made");
  const bool written = write_all(descriptor, content) && fsync(descriptor) == 0;
  std::string problem = written ? "" : failure(beside.data(), "cannot be written");
  close(descriptor);
  if (!problem.empty()) return problem;
  if (std::rename(beside.data(), path.c_str()) != 0) return failure(path, "cannot be replaced");
  sync_folder_of(path);
  return {};
}

std::string remove_file(const std::string& path) {
  if (unlink(path.c_str()) != 0) return errno == ENOENT ? "" : failure(path, "cannot be removed");
  sync_folder_of(path);
  return {};
}

}  // namespace leonav
