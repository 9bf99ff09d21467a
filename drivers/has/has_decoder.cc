#include "drivers/has/has_decoder.h"

namespace leonav {

std::vector<SsrMessage> HasDecoder::add(const CorrectionPage& page) {
  std::vector<SsrMessage> result;
  const auto refuse = [&result](std::uint64_t* counter) {
    ++*counter;
    return result;
  };
  if (page.satellite.system != System::kGalileo || !is_valid(page.satellite)) {
    return refuse(&counters_.bad_satellites);
  }
  if (!page.received.is_set()) return refuse(&counters_.without_time);
  if (!is_intact(page)) return refuse(&counters_.bad_checksums);
  if (is_dummy(page)) return refuse(&counters_.dummies);
  const HasPage has = read_has_page(page);
  if (has.status == kHasDoNotUse) return refuse(&counters_.do_not_use);
  if (has.status != kHasOperational) return refuse(&counters_.not_operational);
  if (has.message_type != 1) return refuse(&counters_.other_types);
  std::optional<std::vector<std::uint8_t>> octets;
  switch (collector_.add(has, page.received, &octets)) {
    case HasPageStatus::kCollected:
      break;
    case HasPageStatus::kRepeated:
      return refuse(&counters_.repeated);
    case HasPageStatus::kBadId:
      return refuse(&counters_.bad_ids);
  }
  ++counters_.pages;
  if (!octets) return result;
  switch (messages_.decode(*octets, page.received, &result, &counters_.left_out)) {
    case HasStatus::kOk:
      ++counters_.messages;
      break;
    case HasStatus::kWithoutMask:
      ++counters_.without_mask;
      break;
    default:
      ++counters_.bad_messages;
  }
  return result;
}

HasCounters HasDecoder::counters() const {
  HasCounters counters = counters_;
  counters.incomplete = collector_.incomplete();
  return counters;
}

}  // namespace leonav
