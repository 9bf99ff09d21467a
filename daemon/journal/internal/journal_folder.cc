#include "daemon/journal/internal/journal_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>

namespace leonav {
namespace {

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

}  // namespace

JournalFolder::JournalFolder(const std::string& path, DiskCalls* disk)
    : path_(folder_of(path)), disk_(disk) {}

JournalFolder::~JournalFolder() {
  if (is_open()) ::close(descriptor_);
}

bool JournalFolder::open(bool make) {
  const auto find = [&] { return ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); };
  long found = (*disk_)(DiskCall::kOpen, find);
  if (found < 0 && disk_->error() == ENOENT && make) {
    (*disk_)(DiskCall::kOpen, [&] { return mkdir(path_.c_str(), 0777); });
    found = (*disk_)(DiskCall::kOpen, find);
  }
  if (found < 0) return false;
  if (is_open()) ::close(descriptor_);
  descriptor_ = static_cast<int>(found);
  return true;
}

bool JournalFolder::is_in_place() {
  struct stat mine {
  }, there{};
  return (*disk_)(DiskCall::kLook, [&] { return fstat(descriptor_, &mine); }) == 0 &&
         (*disk_)(DiskCall::kLook, [&] { return stat(path_.c_str(), &there); }) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

bool JournalFolder::sync() {
  return (*disk_)(DiskCall::kSync, [&] { return fsync(descriptor_); }) == 0 ||
         disk_->error() == EINVAL;  // a file system that cannot
}

void JournalFolder::rewind() {
  (*disk_)(DiskCall::kLook, [&] { return lseek(descriptor_, 0, SEEK_SET); });
}

std::size_t JournalFolder::read() {
  const long size = (*disk_)(
      DiskCall::kLook, [&] { return getdents64(descriptor_, entries_.data(), entries_.size()); });
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

std::int64_t JournalFolder::free_bytes() {
  struct statvfs status {};
  if ((*disk_)(DiskCall::kLook, [&] { return fstatvfs(descriptor_, &status); }) != 0)
    return std::numeric_limits<std::int64_t>::max();
  const double bytes = static_cast<double>(status.f_bavail) * static_cast<double>(status.f_frsize);
  return static_cast<std::int64_t>(std::min(bytes, 1e18));
}

}  // namespace leonav
