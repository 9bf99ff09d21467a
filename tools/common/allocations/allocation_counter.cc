#include "tools/common/allocations/allocation_counter.h"

#include <malloc.h>
#include <sys/prctl.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>

// In glibc a program may replace the malloc family by functions that forward to glibc's entry
// points; operator new and Eigen both call malloc in the end. Sanitizers have their own malloc,
// with hooks for this.
namespace leonav {
namespace {
std::atomic<bool> counting{false};
std::atomic<std::size_t> allocations{0};
constexpr std::array kThreads = {"leonav-ins",     "leonav-gnss", "leonav-smoother", "leonav-out",
                                 "leonav-journal", "leonav-file", "leonav-io",       "leonav-main"};
std::array<std::atomic<std::size_t>, kThreads.size()> by_thread{};
void note() {
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1);
  char name[16] = {};
  prctl(PR_GET_NAME, name);  // a system call, because nothing here may allocate
  for (std::size_t i = 0; i < kThreads.size(); ++i)
    if (std::strcmp(name, kThreads[i]) == 0) by_thread[i].fetch_add(1);
}
}  // namespace

void note_allocation();
void note_allocation() { note(); }
void start_counting_allocations() {
  allocations = 0;
  counting = true;
}
std::size_t stop_counting_allocations() {
  counting = false;
  return allocations;
}

ThreadAllocations thread_allocations() {
  const auto& by = by_thread;
  return {by[0], by[1], by[2], by[3], by[4], by[5], by[6], by[7]};
}

}  // namespace leonav

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*,
                                                                           std::size_t),
                                                         void (*on_free)(const volatile void*));
namespace {
const int hooks_installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { leonav::note_allocation(); },
    [](const volatile void*) {});
}
#else
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  leonav::note_allocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  leonav::note_allocation();
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) {
  leonav::note_allocation();
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  leonav::note_allocation();
  return __libc_memalign(alignment, size);
}
}
#endif
