#include "daemon/checkpoint/internal/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace leonav {
namespace {

std::string failure(const std::string& path, const char* what) {
  return path + ": " + what + ": " + std::strerror(errno);
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
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

std::string replace_file(const std::string& path, std::string_view content) {
  const std::string beside = path + ".tmp";
  const int descriptor =
      open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (descriptor < 0) return failure(beside, "cannot be made");
  const bool written = write_all(descriptor, content) && fsync(descriptor) == 0;
  std::string problem = written ? "" : failure(beside, "cannot be written");
  close(descriptor);
  if (!problem.empty()) return problem;
  if (std::rename(beside.c_str(), path.c_str()) != 0) return failure(path, "cannot be replaced");
  sync_folder_of(path);
  return {};
}

std::string remove_file(const std::string& path) {
  if (unlink(path.c_str()) != 0) return errno == ENOENT ? "" : failure(path, "cannot be removed");
  sync_folder_of(path);
  return {};
}

}  // namespace leonav
