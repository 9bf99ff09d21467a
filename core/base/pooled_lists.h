// PooledLists holds many short lists whose elements lie in one pool: any of them may be long, but
// not all at once.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>

#include "core/base/gps_time.h"

namespace leonav {

// `T` has a member `arrival`, which is larger the later an element has come, and a mutable GpsTime
// `used`. No element is removed but where the pool is used up: it has kElements for all lists
// together, of which one may have kLongest. Allocates when constructed, not after.
template <typename T, std::size_t kLists, std::size_t kLongest, std::size_t kElements>
class PooledLists {
 public:
  // With fewer, a list could be the longest with no element to lose; slots have 16 bits.
  static_assert(kElements >= kLists && kElements <= 65536);

  PooledLists() : pool_(std::make_unique<T[]>(kElements)) {}

  // The elements of a list in the order in which they were appended.
  template <typename Element>
  class Range {
   public:
    class Iterator {
     public:
      using iterator_category = std::forward_iterator_tag;
      using value_type = T;
      using difference_type = std::ptrdiff_t;
      using pointer = Element*;
      using reference = Element&;

      Iterator(Element* pool, const std::uint16_t* slot) : pool_(pool), slot_(slot) {}
      Element& operator*() const { return pool_[*slot_]; }
      Iterator& operator++() {
        ++slot_;
        return *this;
      }
      Iterator operator++(int) { return {pool_, slot_++}; }
      friend bool operator==(const Iterator&, const Iterator&) = default;

     private:
      Element* pool_;
      const std::uint16_t* slot_;
    };

    Range(Element* pool, std::span<const std::uint16_t> slots) : pool_(pool), slots_(slots) {}
    Iterator begin() const { return {pool_, slots_.data()}; }
    Iterator end() const { return {pool_, slots_.data() + slots_.size()}; }
    bool empty() const { return slots_.empty(); }

   private:
    Element* pool_;
    std::span<const std::uint16_t> slots_;
  };
  Range<T> operator[](std::size_t list) { return {pool_.get(), of(list)}; }
  Range<const T> operator[](std::size_t list) const { return {pool_.get(), of(list)}; }
  bool is_full(std::size_t list) const { return lists_[list].size == kLongest; }

  // Notes that the element serves a look-up at `time`; no other state changes. It is in use until
  // a look-up at a time that is kInUse_s away. That is little, because what served a few minutes
  // ago must make room for what is to serve next.
  void mark_used(const T& element, GpsTime time) const { element.used = now_ = time; }
  static constexpr double kInUse_s = 60.0;

  // Whether `a` makes room rather than `b` of the same list: what is in use last, else what arrived
  // first.
  bool makes_room(const T& a, const T& b) const {
    const bool a_used = is_in_use(a), b_used = is_in_use(b);
    return a_used != b_used ? b_used : a.arrival < b.arrival;
  }

  // Appends an element and returns it as T(). Where the pool is used up, the longest list loses the
  // element that makes room first; of several lists as long, that whose first element arrived
  // first. Precondition: the list is not full.
  T& append(std::size_t list) {
    const std::uint16_t slot = used_ < kElements ? static_cast<std::uint16_t>(used_++) : freed();
    List& to = lists_[list];
    to.slots[to.size++] = slot;
    return pool_[slot] = T();
  }

 private:
  struct List {
    std::array<std::uint16_t, kLongest> slots;
    std::uint16_t size = 0;
  };

  bool is_in_use(const T& element) const {
    return element.used.is_set() && std::abs(seconds_between(now_, element.used)) < kInUse_s;
  }

  std::span<const std::uint16_t> of(std::size_t list) const {
    return std::span(lists_[list].slots).first(lists_[list].size);
  }

  std::uint16_t freed() {
    List& longest =
        *std::max_element(lists_.begin(), lists_.end(), [this](const List& a, const List& b) {
          if (a.size != b.size || a.size == 0) return a.size < b.size;
          return pool_[a.slots[0]].arrival > pool_[b.slots[0]].arrival;
        });
    const auto end = longest.slots.begin() + longest.size;
    const auto first = std::min_element(
        longest.slots.begin(), end,
        [this](std::uint16_t a, std::uint16_t b) { return makes_room(pool_[a], pool_[b]); });
    const std::uint16_t slot = *first;
    std::copy(first + 1, end, first);
    --longest.size;
    return slot;
  }

  mutable GpsTime now_;  // of the last look-up
  std::unique_ptr<T[]> pool_;
  std::size_t used_ = 0;
  std::array<List, kLists> lists_{};
};

}  // namespace leonav
