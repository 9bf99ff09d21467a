// The JournalFolder is the directory of a journal, found by its path.
#pragma once
#include <dirent.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/journal/internal/disk_calls.h"

namespace leonav {

// Allocates at construction only, and looks for nothing then.
class JournalFolder {
 public:
  // `path`: journal.path.
  JournalFolder(const std::string& path, DiskCalls* disk);
  ~JournalFolder();
  JournalFolder(const JournalFolder&) = delete;
  JournalFolder& operator=(const JournalFolder&) = delete;

  // Finds the folder that has the path now, which may be another one than before. `make`: where it
  // is gone, it is made again, but nothing above it. False: the reason is in the calls' error().
  bool open(bool make);
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  // Whether the open folder is the one that has the path.
  bool is_in_place();
  // Waits until names are on the disk.
  bool sync();

  // Calls use(name) for each entry.
  template <typename Use>
  void for_each_name(Use&& use) {
    rewind();
    for (std::size_t size = read(); size > 0; size = read()) {
      for (std::size_t at = 0; at < size;) {
        const auto* entry = reinterpret_cast<const dirent64*>(entries_.data() + at);
        use(static_cast<const char*>(entry->d_name));
        at += entry->d_reclen;
      }
    }
  }

  // Bytes that may be written to the file system; the largest number where it is not known.
  std::int64_t free_bytes();

 private:
  void rewind();
  std::size_t read();  // the next entries; returns their bytes

  std::string path_;
  DiskCalls* disk_;
  int descriptor_ = -1;
  alignas(dirent64) std::array<char, 8192> entries_;
};

}  // namespace leonav
