// DiskCall names the system calls of the journal, for tests that make one of them wait or fail.
#pragma once
#include <cstdint>
#include <functional>

namespace leonav {

enum class DiskCall : std::uint8_t {
  kOpen,   // a file, or the folder
  kLook,   // at the folder's entries, and at the ends of files
  kWrite,  // also: cutting off
  kSync,   // until it is on the disk
  kRename,
  kDelete,
};

// Called before each of them. It may wait itself, and what it returns, unless 0, is the errno with
// which the call fails. Empty in production.
using DiskHook = std::function<int(DiskCall)>;

}  // namespace leonav
