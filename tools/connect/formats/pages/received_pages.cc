#include "tools/connect/formats/pages/received_pages.h"

namespace leonav {

void ReceivedPages::take(const CorrectionPage& page) {
  if (!is_used_) return;
  has_come_ = true;
  for (const SsrMessage& message : decoder_.add(page)) {
    published_ += static_cast<std::uint64_t>(corrections_->take(message, page.received));
  }
}

std::string ReceivedPages::text(const std::string& without_any) const {
  if (!is_used_) return "";
  if (!has_come_) return without_any;
  if (published_ > 0) return corrections_->detail();
  std::string why = "pages of corrections, but nothing made of them yet";
  for (const auto& [reason, count] : decoder_.left_out())
    why += ", " + std::to_string(count) + " x " + reason;
  return why;
}

}  // namespace leonav
