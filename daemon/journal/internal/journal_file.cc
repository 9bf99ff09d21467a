#include "daemon/journal/internal/journal_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "daemon/threads/wall_clock.h"

namespace leonav {
namespace {

constexpr mode_t kMode = 0666;

}  // namespace

template <typename Call>
long JournalFile::wait_for(Call&& call) {
  counters_->waiting_since_ns.set(monotonic_ns());
  error_ = before_call_ ? before_call_() : 0;
  long result = -1;
  if (error_ == 0) {
    do {
      result = call();
    } while (result < 0 && errno == EINTR);
    if (result < 0) error_ = errno;
  }
  counters_->waiting_since_ns.set(0);
  return result;
}

bool JournalFile::open(int folder, const char* name, bool create) {
  close();
  const int flags = O_WRONLY | O_CLOEXEC | (create ? O_CREAT | O_EXCL : 0);
  descriptor_ = static_cast<int>(wait_for([&] { return openat(folder, name, flags, kMode); }));
  if (descriptor_ < 0) return false;
  struct stat status {};
  regular_ = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (regular_) flock(descriptor_, LOCK_EX | LOCK_NB);  // a file system without locks is no failure
  return true;
}

std::size_t JournalFile::write(std::span<const std::uint8_t> bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const long count = wait_for(
        [&] { return ::write(descriptor_, bytes.data() + written, bytes.size() - written); });
    if (count == 0) error_ = EIO;
    if (count <= 0) break;
    written += static_cast<std::size_t>(count);
  }
  return written;
}

void JournalFile::truncate(std::int64_t size) {
  if (!regular_ || ftruncate(descriptor_, size) != 0) return;
  lseek(descriptor_, size, SEEK_SET);
}

bool JournalFile::sync() {
  if (wait_for([&] { return fsync(descriptor_); }) == 0) return true;
  // Pipes and special files cannot be synchronized; that is no error.
  return error_ == EINVAL || error_ == EROFS;
}

void JournalFile::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace leonav
