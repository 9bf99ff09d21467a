// The HasPageCollector collects the pages of HAS messages from all satellites.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/has/has_page.h"

namespace leonav {

// What became of a page.
enum class HasPageStatus : std::uint8_t {
  kCollected = 0,
  kRepeated,  // the same page of the same message has come, or the message is complete
  kBadId,     // number 0, or of an octet beyond the message, which is never sent
};

// Satellites send different pages of the same message at the same time, and repeat it. A message is
// known by its number (MID) and its size. Its pages must come within kLongest_s of the first one:
// the number is used again later. Of each number one message is collected, so that memory is
// bounded.
class HasPageCollector {
 public:
  static constexpr double kLongest_s = 150.0;  // Galileo HAS SIS ICD 1.0, 6.4.1

  // Takes a page received at `received`. `message` gets the octets of the message that it
  // completes, once for each message, or becomes empty.
  HasPageStatus add(const HasPage& page, GpsTime received,
                    std::optional<std::vector<std::uint8_t>>* message);
  // Messages that were begun and never completed.
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  struct Message {
    std::uint8_t size = 0;  // 0: none
    GpsTime begun;
    bool is_complete = false;
    std::vector<EncodedPage> pages;
  };

  std::array<Message, 32> messages_;
  std::uint64_t incomplete_ = 0;
};

}  // namespace leonav
