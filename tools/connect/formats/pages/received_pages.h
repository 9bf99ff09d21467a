// ReceivedPages publishes what the pages of corrections in a receiver's stream make of the
// broadcast messages.
#pragma once
#include <cstdint>
#include <string>

#include "tools/connect/formats/outputs/correction_output.h"
#include "tools/import/page_decoder.h"

namespace leonav {

class ReceivedPages {
 public:
  // `is_used`: false leaves all pages out. `corrections` must be given where they are used, and
  // outlive this object.
  ReceivedPages(bool is_used, CorrectionOutput* corrections)
      : is_used_(is_used), corrections_(corrections) {}

  void take(const CorrectionPage& page);

  std::uint64_t published() const { return published_; }  // messages
  std::uint64_t damaged() const { return decoder_.damaged(); }
  std::uint64_t refused() const { return decoder_.refused(); }
  // What came, or why nothing was published, in a few words; empty where pages are not used.
  // `without_any`: what to say where no page has come.
  std::string text(const std::string& without_any) const;

 private:
  bool is_used_;
  CorrectionOutput* corrections_;
  PageDecoder decoder_;
  bool has_come_ = false;
  std::uint64_t published_ = 0;
};

}  // namespace leonav
