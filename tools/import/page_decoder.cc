#include "tools/import/page_decoder.h"

namespace leonav {

std::vector<SsrMessage> PageDecoder::add(const CorrectionPage& page) {
  return page.service == PageService::kGalileoHas ? has_.add(page) : b2b_.add(page);
}

std::uint64_t PageDecoder::messages() const {
  return has_.counters().messages + b2b_.counters().messages;
}

std::uint64_t PageDecoder::damaged() const {
  return has_.counters().bad_checksums + b2b_.counters().bad_checksums;
}

std::uint64_t PageDecoder::refused() const {
  const HasCounters h = has_.counters();
  const B2bCounters& b = b2b_.counters();
  return h.bad_satellites + h.without_time + h.not_operational + h.do_not_use + h.other_types +
         h.bad_ids + h.bad_messages + h.without_mask + b.bad_satellites + b.without_time +
         b.bad_time + b.without_mask + b.bad_length;
}

std::vector<std::pair<std::string, std::uint64_t>> PageDecoder::left_out() const {
  const HasCounters h = has_.counters();
  const B2bCounters& b = b2b_.counters();
  std::vector<std::pair<std::string, std::uint64_t>> all = {
      {"page with a wrong checksum", damaged()},
      {"page of a satellite that does not exist", h.bad_satellites + b.bad_satellites},
      {"page before the receiver knew the time", h.without_time + b.without_time},
      {"page of HAS in test", h.not_operational},
      {"page of HAS that says that it must not be used", h.do_not_use},
      {"page of a message type of HAS that is not defined", h.other_types},
      {"page with a number that no message of HAS has", h.bad_ids},
      {"message of HAS of which pages are missing", h.incomplete},
      {"message of HAS that is not as defined", h.bad_messages},
      {"message whose mask has not come", h.without_mask + b.without_mask},
      {"correction or bias that is marked as not available",
       h.left_out.unavailable + b.unavailable},
      {"clock of a satellite that must not be used", h.left_out.do_not_use},
      {"bias of a signal without a name", h.left_out.reserved_signals + b.reserved_signals},
      {"correction of a broadcast message that is not defined", h.left_out.other_navigation},
      {"message of PPP-B2b that is not as defined", b.bad_time + b.bad_length},
      {"correction of a system not used", b.other_systems}};
  for (const auto& [type, count] : b.other_types) {
    all.emplace_back("message of PPP-B2b of type " + std::to_string(type), count);
  }
  std::erase_if(all, [](const auto& one) { return one.second == 0; });
  return all;
}

}  // namespace leonav
