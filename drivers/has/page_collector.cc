#include "drivers/has/page_collector.h"

#include <algorithm>

namespace leonav {

HasPageStatus HasPageCollector::add(const HasPage& page, GpsTime received,
                                    std::optional<std::vector<std::uint8_t>>* message) {
  message->reset();
  const EncodedPage& encoded = page.encoded;
  const bool is_beyond = encoded.id > page.message_size && encoded.id <= kMaxHasPages;
  if (encoded.id == 0 || is_beyond) return HasPageStatus::kBadId;

  Message& m = messages_[page.message_id % messages_.size()];
  const double age_s = m.size == 0 ? 0.0 : seconds_between(received, m.begun);
  if (m.size != page.message_size || age_s > kLongest_s || age_s < -kLongest_s) {
    incomplete_ += m.size != 0 && !m.is_complete;
    m = {page.message_size, received, false, {}};
  }
  const bool has_come = std::any_of(m.pages.begin(), m.pages.end(),
                                    [&](const EncodedPage& p) { return p.id == encoded.id; });
  if (m.is_complete || has_come) return HasPageStatus::kRepeated;
  m.pages.push_back(encoded);
  if (m.pages.size() == m.size) {
    *message = decode_reed_solomon(m.pages);
    m.is_complete = true;
    m.pages.clear();
  }
  return HasPageStatus::kCollected;
}

}  // namespace leonav
