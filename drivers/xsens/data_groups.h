// The DataGroups are the groups of data that an MTData2 message consists of.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/big_endian.h"

namespace leonav {

// One group. The identifier is that of its kind; the four bits below name the precision of its
// numbers (bits 0 and 1) and the coordinate system of an orientation (bits 2 and 3).
struct DataGroup {
  std::uint16_t identifier = 0;
  std::span<const std::uint8_t> data;

  std::uint16_t kind() const { return identifier & 0xFFF0; }
  int precision() const { return identifier & 3; }
};

// Groups follow each other: two bytes of identifier, one of length, the data.
class DataGroups {
 public:
  explicit DataGroups(std::span<const std::uint8_t> payload) : rest_(payload) {}

  // Takes the next group; returns false at the end, or where the rest is too short for one.
  bool next(DataGroup* group) {
    if (rest_.size() < kHeader || rest_.size() < kHeader + rest_[2]) return false;
    *group = {read_big_u2(rest_.data()), rest_.subspan(kHeader, rest_[2])};
    rest_ = rest_.subspan(kHeader + group->data.size());
    return true;
  }

  // Returns whether the groups of a payload end with its last byte. One without groups counts.
  static bool fill(std::span<const std::uint8_t> payload) {
    DataGroups groups(payload);
    for (DataGroup group; groups.next(&group);) {
    }
    return groups.rest_.empty();
  }

 private:
  static constexpr std::size_t kHeader = 3;
  std::span<const std::uint8_t> rest_;
};

}  // namespace leonav
