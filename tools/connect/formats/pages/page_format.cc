#include "tools/connect/formats/pages/page_format.h"

namespace leonav {

void PageFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t) {
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      take_line();
    } else if (line_.size() == kMaxLine) {
      overflows_ = true;
    } else {
      line_.push_back(static_cast<char>(byte));
    }
  }
}

void PageFormat::take_line() {
  if (line_.ends_with('\r')) line_.pop_back();
  const auto page = overflows_ ? std::nullopt : page_from_line(line_, service_);
  const bool is_bad = !page && (overflows_ || !is_remark(line_));
  line_.clear();
  overflows_ = false;
  bad_lines_ += is_bad;
  if (!page) return;
  ++pages_;
  if (page->received > last_) last_ = page->received;
  for (const SsrMessage& message : decoder_.add(*page)) {
    published_ += static_cast<std::uint64_t>(corrections_->take(message, page->received));
  }
}

FormatCounts PageFormat::counts() const {
  FormatCounts counts;
  counts.frames = pages_;
  counts.messages = published_;
  counts.damaged = bad_lines_ + decoder_.damaged();
  counts.refused = decoder_.refused();
  return counts;
}

std::optional<DataTime> PageFormat::data_time() const {
  if (!last_.is_set()) return std::nullopt;
  return DataTime{true, last_.nanoseconds()};
}

std::string PageFormat::why_no_frames() const {
  return "bytes arrive but no line of a page: GPS week, second, satellite, a number, length and "
         "hexadecimal octets are needed";
}

std::string PageFormat::why_no_messages() const {
  std::string why = "pages arrive, but no message is complete";
  if (decoder_.messages() > 0) {
    why = "corrections arrive, but " + corrections_->why_none();
  }
  const char* separator = "; left out: ";
  for (const auto& [reason, count] : decoder_.left_out()) {
    why += separator + std::to_string(count) + " x " + reason;
    separator = ", ";
  }
  return why;
}

}  // namespace leonav
