#include "daemon/threads/process_memory.h"

#include <link.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "daemon/threads/realtime_thread.h"

namespace leonav {
namespace {

constexpr int kLargeBlockBytes = 128 << 10;

// Ceres' libraries, and those that only they need.
constexpr std::array<std::string_view, 15> kOfCeres = {
    "blas", "lapack",   "gfortran",    "quadmath", "gomp", "cholmod", "metis", "colamd.",
    "amd.", "cxsparse", "suitesparse", "gflags",   "glog", "unwind",  "lzma"};

bool is_of_ceres(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  for (const std::string_view part : kOfCeres)
    if (name.find(part) != name.npos) return true;
  return false;
}

// What is not written is still in the file, from where it comes back if it is ever used.
int unlock_if_of_ceres(dl_phdr_info* library, std::size_t, void*) {
  if (!is_of_ceres(library->dlpi_name)) return 0;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  for (int i = 0; i < library->dlpi_phnum; ++i) {
    const auto& segment = library->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t end = library->dlpi_addr + segment.p_vaddr + segment.p_memsz;
    void* const address = reinterpret_cast<void*>(begin);
    if (munlock(address, end - begin) == 0) madvise(address, end - begin, MADV_DONTNEED);
  }
  return 0;
}

// Brings in what is locked, so that no use of it has to wait.
void populate(std::ifstream* maps) {
  for (std::string line; std::getline(*maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    char permissions[5] = {};
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %4s", &begin, &end, permissions) != 3)
      continue;
    if (is_of_ceres(line) && permissions[1] != 'w') continue;
    mlock(reinterpret_cast<void*>(begin), end - begin);  // fails for what is the system's own
  }
}

}  // namespace

void prepare_memory() {
  mallopt(M_MMAP_THRESHOLD, kLargeBlockBytes);
  // Threads allocate next to nothing; an arena of their own would take 64 MB of addresses each.
  mallopt(M_ARENA_MAX, 1);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, RealtimeThread::kStackBytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

std::string lock_memory(bool uses_ceres) {
  malloc_trim(0);
  std::ifstream maps("/proc/self/maps");
  const bool in_parts = !uses_ceres && maps;
  // In parts: what is there is locked but not brought in, or Ceres' libraries would be too.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | (in_parts ? MCL_ONFAULT : 0)) != 0)
    return std::string("memory is not locked: ") + std::strerror(errno);
  if (!uses_ceres) dl_iterate_phdr(unlock_if_of_ceres, nullptr);
  if (!in_parts) return {};
  populate(&maps);
  mlockall(MCL_FUTURE);  // what comes is brought in at once
  return {};
}

}  // namespace leonav
