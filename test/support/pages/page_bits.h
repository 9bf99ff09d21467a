// Writes messages and pages of HAS and PPP-B2b field by field.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "drivers/binary/correction_page.h"

namespace leonav::test {

// Bits, the most significant first.
class PageBits {
 public:
  PageBits& add(std::uint64_t value, int count) {
    for (int bit = count - 1; bit >= 0; --bit) {
      bits_.push_back(bit < 64 && (value >> bit & 1U) != 0);
    }
    return *this;
  }
  PageBits& signed_number(std::int64_t value, int count) {
    return add(static_cast<std::uint64_t>(value), count);
  }
  // `count` bits of which those with these numbers are set; the first one has the number `first`.
  PageBits& flags(int count, std::initializer_list<int> set, int first) {
    for (int i = first; i < first + count; ++i) {
      bool is_set = false;
      for (const int one : set) is_set = is_set || one == i;
      bits_.push_back(is_set);
    }
    return *this;
  }
  // The header of message type 1; `flags`: mask 32, orbits 16, clocks 8, subset 4, code biases 2,
  // phase biases 1.
  PageBits& header(std::uint32_t toh_s, std::uint32_t flags, std::uint32_t mask_id,
                   std::uint32_t issue) {
    return add(toh_s, 12).add(flags, 6).add(0, 4).add(mask_id, 5).add(issue, 5);
  }
  std::vector<std::uint8_t> octets() const {
    std::vector<std::uint8_t> octets((bits_.size() + 7) / 8);
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      if (bits_[i]) octets[i / 8] = static_cast<std::uint8_t>(octets[i / 8] | 0x80U >> i % 8);
    }
    return octets;
  }
  // A page whose first bits are these, with its checksum by long division.
  CorrectionPage page(PageService service, SatelliteId satellite, GpsTime received) const {
    std::vector<bool> all = bits_;
    all.resize(CorrectionPage::kContentBits);
    std::vector<bool> rest = all;
    rest.resize(CorrectionPage::kBits);
    constexpr std::uint32_t kGenerator = 0x1864CFB;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!rest[i]) continue;
      for (std::size_t k = 0; k <= 24; ++k) {
        rest[i + k] = rest[i + k] != ((kGenerator >> (24 - k) & 1U) != 0);
      }
    }
    all.insert(all.end(), rest.end() - 24, rest.end());
    CorrectionPage page;
    page.service = service;
    page.satellite = satellite;
    page.received = received;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i]) page.bits[i / 8] = static_cast<std::uint8_t>(page.bits[i / 8] | 0x80U >> i % 8);
    }
    return page;
  }

 private:
  std::vector<bool> bits_;
};

}  // namespace leonav::test
