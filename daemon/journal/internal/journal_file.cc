#include "daemon/journal/internal/journal_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <utility>

namespace leonav {
namespace {

constexpr mode_t kMode = 0666;

void close_one(int* descriptor) {
  const int number = std::exchange(*descriptor, -1);
  if (number >= 0) ::close(number);
}

}  // namespace

bool JournalFile::open(int folder, const char* name, bool create) {
  drop();
  const int flags = O_WRONLY | O_CLOEXEC | (create ? O_CREAT | O_EXCL : 0);
  descriptor_ = static_cast<int>(
      (*disk_)(DiskCall::kOpen, [&] { return openat(folder, name, flags, kMode); }));
  if (descriptor_ < 0) return false;
  struct stat status {};
  regular_ = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  inode_ = status.st_ino;
  // Another daemon holds a new file while it looks whether it is in use, and no longer. A file
  // system without locks is no failure.
  const int lock = create ? LOCK_EX : LOCK_EX | LOCK_NB;
  if (regular_) (*disk_)(DiskCall::kLook, [&] { return flock(descriptor_, lock); });
  return true;
}

std::size_t JournalFile::write(std::span<const std::uint8_t> bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const long count = (*disk_)(DiskCall::kWrite, [&] {
      return ::write(descriptor_, bytes.data() + written, bytes.size() - written);
    });
    if (count == 0) disk_->set_error(EIO);
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  return written;
}

void JournalFile::truncate(std::int64_t size) {
  if (!regular_) return;
  if ((*disk_)(DiskCall::kWrite, [&] { return ftruncate(descriptor_, size); }) != 0) return;
  lseek(descriptor_, size, SEEK_SET);
}

bool JournalFile::sync() {
  if ((*disk_)(DiskCall::kSync, [&] { return fdatasync(descriptor_); }) == 0) return true;
  // Pipes and special files cannot be synchronized; that is no error.
  return disk_->error() == EINVAL || disk_->error() == EROFS;
}

bool JournalFile::is_in_place(int folder, const char* name) {
  struct stat mine {
  }, there{};
  return (*disk_)(DiskCall::kLook, [&] { return fstat(descriptor_, &mine); }) == 0 &&
         (*disk_)(DiskCall::kLook,
                  [&] { return fstatat(folder, name, &there, AT_SYMLINK_NOFOLLOW); }) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

void JournalFile::end() {
  if (!is_open()) return;
  close_one(&ended_);
  ended_ = std::exchange(descriptor_, -1);
}

void JournalFile::drop() { close_one(&descriptor_); }

void JournalFile::release_earlier() { close_one(&ended_); }

void JournalFile::close() {
  drop();
  release_earlier();
}

}  // namespace leonav
