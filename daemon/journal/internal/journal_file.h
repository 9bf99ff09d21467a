// A JournalFile is the file that is written, one piece after the other.
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "daemon/journal/internal/disk_calls.h"

namespace leonav {

// It is locked (flock) while it is open, so that no other daemon deletes or renames it; and a piece
// that has ended stays locked until the next one has begun, so that a journal that is written never
// looks like one of a crash. Allocates nothing. Functions that fail leave the reason in the calls'
// error().
class JournalFile {
 public:
  explicit JournalFile(DiskCalls* disk) : disk_(disk) {}
  ~JournalFile() { close(); }
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // `name` in `folder`. `create`: a file of that name must not exist.
  bool open(int folder, const char* name, bool create);
  // Appends bytes; returns how many were written, all of them unless it fails.
  std::size_t write(std::span<const std::uint8_t> bytes);
  // Cuts off what was written beyond `size`.
  void truncate(std::int64_t size);
  // Waits until what was written is on the disk.
  bool sync();
  // Whether the file still has this name in `folder`.
  bool is_in_place(int folder, const char* name);

  // No more is written to it; it stays locked until release_earlier() or the next end().
  void end();
  // The file is of no use; what has ended before it stays locked.
  void drop();
  void release_earlier();
  void close();

  bool is_open() const { return descriptor_ >= 0; }
  // Whether it is a file on a disk, not a pipe or a device.
  bool is_regular() const { return regular_; }
  // Tells the file that was opened last from others of its name.
  ino_t inode() const { return inode_; }

 private:
  DiskCalls* disk_;
  int descriptor_ = -1, ended_ = -1;
  bool regular_ = false;
  ino_t inode_ = 0;
};

}  // namespace leonav
