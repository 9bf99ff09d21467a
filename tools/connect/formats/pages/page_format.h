// The PageFormat publishes what the pages of a correction service, as lines of text, make of the
// broadcast ephemerides of other streams.
#pragma once
#include <string>

#include "drivers/page_lines/page_line.h"
#include "tools/connect/formats/outputs/correction_output.h"
#include "tools/connect/formats/stream_format.h"
#include "tools/import/page_decoder.h"

namespace leonav {

// The messages are those that leonav-import writes from the same lines: CORRECTED_STATES and BIASES
// of each message that a page completes, at the time in its line.
class PageFormat final : public StreamFormat {
 public:
  static constexpr std::size_t kMaxLine = 1024;

  // `corrections` must outlive this object.
  PageFormat(PageService service, CorrectionOutput* corrections)
      : service_(service), corrections_(corrections) {}

  void feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) override;
  void finish() override { take_line(); }
  FormatCounts counts() const override;
  std::optional<DataTime> data_time() const override;
  std::string detail() const override { return corrections_->detail(); }
  std::string why_no_frames() const override;
  std::string why_no_messages() const override;

 private:
  void take_line();

  PageService service_;
  CorrectionOutput* corrections_;
  PageDecoder decoder_;
  std::string line_;        // that is not complete yet
  bool overflows_ = false;  // that line is too long, and dropped up to its end
  GpsTime last_;            // of the newest page
  std::uint64_t pages_ = 0, bad_lines_ = 0, published_ = 0;
};

}  // namespace leonav
