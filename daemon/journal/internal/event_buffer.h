// The EventBuffer holds events of a log, encoded, until the disk has taken them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace leonav {

// Its memory is taken at construction.
class EventBuffer {
 public:
  explicit EventBuffer(std::size_t capacity) { bytes_.reserve(capacity); }

  // False: there is no room.
  bool append(std::int64_t number, std::int64_t timestamp_us, std::string_view channel,
              std::span<const std::uint8_t> data);
  bool has_room(std::size_t bytes) const { return bytes_.capacity() - bytes_.size() >= bytes; }
  std::span<const std::uint8_t> bytes() const { return bytes_; }
  std::int64_t events() const { return events_; }
  bool empty() const { return bytes_.empty(); }
  void clear() {
    bytes_.clear();
    events_ = 0;
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::int64_t events_ = 0;
};

}  // namespace leonav
