#include "test/fuzz/memory_file.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace leonav::test {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

MemoryFile::MemoryFile() : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
  if (descriptor_ < 0) fail("memfd_create");
  if (fchmod(descriptor_, S_IRUSR | S_IWUSR) != 0) fail("fchmod");
  path_ = "/proc/self/fd/" + std::to_string(descriptor_);
}

MemoryFile::~MemoryFile() { close(descriptor_); }

void MemoryFile::write(FuzzBytes bytes) {
  if (ftruncate(descriptor_, 0) != 0) fail("ftruncate");
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count =
        pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (count <= 0) fail("pwrite");
    done += static_cast<std::size_t>(count);
  }
}

const std::string& path_of_file_with(FuzzBytes bytes) {
  static MemoryFile file;
  file.write(bytes);
  return file.path();
}

}  // namespace leonav::test
