// This unit decodes the Galileo High Accuracy Service from the pages of E6-B.
#pragma once
#include <cstdint>
#include <vector>

#include "drivers/binary/correction_page.h"
#include "drivers/has/has_message.h"
#include "drivers/has/page_collector.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// Counts of pages and messages.
struct HasCounters {
  std::uint64_t pages = 0;  // with a part of a message
  std::uint64_t bad_checksums = 0;
  std::uint64_t bad_satellites = 0;  // another system's, or no valid number
  std::uint64_t without_time = 0;
  std::uint64_t dummies = 0;
  std::uint64_t not_operational = 0;  // the service is in test, or its state is reserved
  std::uint64_t do_not_use = 0;       // the service says that it must not be used
  std::uint64_t other_types = 0;      // a message type that is not defined
  std::uint64_t bad_ids = 0;          // HasPageStatus::kBadId
  std::uint64_t repeated = 0;
  std::uint64_t messages = 0;  // decoded
  std::uint64_t incomplete = 0;
  std::uint64_t bad_messages = 0;  // length, time, mask, subset or validity is not as defined
  std::uint64_t without_mask = 0;
  HasLeftOut left_out;
};

// The decoder takes pages of all satellites in the order of their arrival. Memory is bounded.
class HasDecoder {
 public:
  // Returns the corrections of the message that the page completes; empty if it completes none.
  std::vector<SsrMessage> add(const CorrectionPage& page);
  HasCounters counters() const;

 private:
  HasPageCollector collector_;
  HasMessages messages_;
  HasCounters counters_;
};

}  // namespace leonav
