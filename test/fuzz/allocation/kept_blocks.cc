// Large blocks of memory are kept for the next input that takes one of the same size. The address
// sanitizer gives such a block back to the kernel, and clearing its pages again for every input
// took half of the time of a receiver's decoder. Between blocks lie pages that the program must not
// touch, and a block that is not taken must not be touched either.
#include <sanitizer/asan_interface.h>
#include <sanitizer/lsan_interface.h>
#include <sys/mman.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kLeast = 4 * kPage;    // smaller ones are the sanitizer's
constexpr std::size_t kMost = 256 * kPage;   // and so are larger ones
constexpr std::size_t kAll = 16384 * kPage;  // all blocks together

// Stands in the page before its block, where only the functions of this file look.
struct Header {
  std::size_t pages;
  Header* next;  // of the blocks of this size that are not taken
};

std::uint8_t *begin = nullptr, *unused = nullptr, *end = nullptr;
std::array<Header*, kMost / kPage + 1> kept{};

void map_all() {
  void* mapped = mmap(nullptr, kAll, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) std::abort();
  begin = unused = static_cast<std::uint8_t*>(mapped);
  end = begin + kAll;
  ASAN_POISON_MEMORY_REGION(begin, kAll);
  __lsan_register_root_region(begin, kAll);  // what kept blocks point to is no leak
}

// Returns null if there is no room.
__attribute__((no_sanitize("address"))) Header* take(std::size_t pages) {
  if (begin == nullptr) map_all();
  if (Header* header = kept[pages]; header != nullptr) {
    kept[pages] = header->next;
    return header;
  }
  const std::size_t length = (1 + pages) * kPage;
  if (length + kPage > static_cast<std::size_t>(end - unused)) return nullptr;
  auto* header = reinterpret_cast<Header*>(unused);
  unused += length;
  header->pages = pages;
  return header;
}

void* allocate(std::size_t size) {
  if (size >= kLeast && size <= kMost) {
    if (Header* header = take((size + kPage - 1) / kPage); header != nullptr) {
      std::uint8_t* block = reinterpret_cast<std::uint8_t*>(header) + kPage;
      ASAN_UNPOISON_MEMORY_REGION(block, size);
      std::memset(block, 0, size);  // what the input before left would make findings depend on it
      return block;
    }
  }
  return std::malloc(size != 0 ? size : 1);
}

__attribute__((no_sanitize("address"))) void release(void* pointer) {
  auto* block = static_cast<std::uint8_t*>(pointer);
  if (block < begin || block >= end) return std::free(pointer);
  auto* header = reinterpret_cast<Header*>(block - kPage);
  ASAN_POISON_MEMORY_REGION(block, header->pages * kPage);
  header->next = kept[header->pages];
  kept[header->pages] = header;
}

}  // namespace

void* operator new(std::size_t size) {
  void* block = allocate(size);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* pointer) noexcept { release(pointer); }
void operator delete(void* pointer, std::size_t) noexcept { release(pointer); }
void operator delete(void* pointer, const std::nothrow_t&) noexcept { release(pointer); }
