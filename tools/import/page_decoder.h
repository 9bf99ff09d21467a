// The PageDecoder decodes pages of whichever service they are of, and tells what was left out.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "drivers/b2b/b2b_decoder.h"
#include "drivers/has/has_decoder.h"

namespace leonav {

// It serves leonav-import and leonav-connect, so that both make the same of the same pages.
class PageDecoder {
 public:
  // Returns the corrections of the message that the page completes; empty if it completes none.
  std::vector<SsrMessage> add(const CorrectionPage& page);

  // Messages decoded, pages with a wrong checksum, and whole pages and messages that cannot be
  // used.
  std::uint64_t messages() const;
  std::uint64_t damaged() const;
  std::uint64_t refused() const;
  // What was left out and why, with counts above 0.
  std::vector<std::pair<std::string, std::uint64_t>> left_out() const;

 private:
  HasDecoder has_;
  B2bDecoder b2b_;
};

}  // namespace leonav
