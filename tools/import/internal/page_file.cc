#include "tools/import/internal/page_file.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "drivers/page_lines/page_file_reader.h"
#include "drivers/sbf/sbf_file_reader.h"
#include "drivers/text/parse.h"
#include "drivers/ubx/ubx_file_reader.h"
#include "tools/import/internal/observation_file.h"
#include "tools/import/page_decoder.h"

namespace leonav {
namespace {

using PageTaker = std::function<void(const CorrectionPage&)>;

void read_lines(const std::string& path, const PageTaker& take, ImportReport* report) {
  const bool is_b2b = has_ending(path, ".b2b");
  PageFileReader reader(path, is_b2b ? PageService::kBeidouB2b : PageService::kGalileoHas);
  for (CorrectionPage page; reader.next(&page);) take(page);
  const PageFileCounters& c = reader.counters();
  report->skip(path + ":" + std::to_string(c.first_bad_line), "line that is no page", c.bad_lines);
}

// Reads the pages between the other messages of a receiver.
template <typename Reader, typename Output>
void read_receiver(const std::string& path, const PageTaker& take) {
  Reader reader(path);
  for (Output output; reader.next(&output);) {
    if (const auto* page = std::get_if<CorrectionPage>(&output)) take(*page);
  }
}

}  // namespace

bool has_page_name(const std::string& path) {
  return has_ending(path, ".has") || has_ending(path, ".b2b") || has_ending(path, ".ubx") ||
         has_ending(path, ".sbf");
}

std::vector<ScheduledCorrection> read_pages(const std::string& path, ImportReport* report) {
  PageDecoder decoder;
  std::vector<ScheduledCorrection> corrections;
  const auto take = [&](const CorrectionPage& page) {
    for (SsrMessage& message : decoder.add(page)) {
      corrections.push_back({page.received, std::move(message), 0});
    }
  };
  if (has_ending(path, ".ubx")) {
    read_receiver<UbxFileReader, UbxOutput>(path, take);
  } else if (has_ending(path, ".sbf")) {
    read_receiver<SbfFileReader, SbfOutput>(path, take);
  } else {
    read_lines(path, take, report);
  }
  std::string why = "holds no usable message of corrections";
  for (const auto& [reason, count] : decoder.left_out()) {
    report->skip(path, reason, static_cast<long>(count));
    why += "; " + std::to_string(count) + " x " + reason;
  }
  if (corrections.empty()) {
    throw FileError(path, 0, why + "; see the form of pages in docs/operations/connect.md");
  }
  std::stable_sort(corrections.begin(), corrections.end(),
                   [](const auto& a, const auto& b) { return a.arrival < b.arrival; });
  return corrections;
}

}  // namespace leonav
