#include "tools/import/internal/corrections.h"

#include <algorithm>
#include <filesystem>

#include "drivers/text/parse.h"
#include "tools/import/internal/rtcm3_file.h"
#include "tools/import/product_schedule.h"
#include "tools/import/unused_corrections.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxChanges = 20;  // that are told one by one

}  // namespace

std::vector<ScheduledCorrection> read_corrections(const std::string& path, GpsTime date,
                                                  double latency_s, ImportReport* report) {
  Rtcm3FileReader reader = open_rtcm3(path, date);
  std::vector<ScheduledCorrection> corrections;
  std::vector<Ephemeris> before_first;
  bool has_ssr = false;
  long epochs = 0;
  for (Rtcm3Output output; reader.next(&output);) {
    if (const auto* message = std::get_if<SsrMessage>(&output)) {
      GpsTime arrival = message->time.plus_seconds(latency_s);
      // Some services send biases with the time at which they were determined, hours ago.
      const bool has_biases =
          message->kind == SsrKind::kCodeBias || message->kind == SsrKind::kPhaseBias;
      if (has_biases && !corrections.empty())
        arrival = std::max(arrival, corrections.back().arrival);
      for (const Ephemeris& e : before_first) corrections.push_back({arrival, e, 0});
      before_first.clear();
      corrections.push_back({arrival, *message, 0});
      has_ssr = true;
    } else if (const auto* ephemeris = std::get_if<Ephemeris>(&output)) {
      if (has_ssr) {
        corrections.push_back({corrections.back().arrival, *ephemeris, 0});
      } else {
        before_first.push_back(*ephemeris);
      }
    }
    epochs += std::holds_alternative<RawEpoch>(output);
  }
  report_rtcm3(path, reader.counters(), report);
  report->skip(path, "epoch in a file of corrections (list it under observations)", epochs);
  if (!has_ssr) throw FileError(path, 0, "holds no usable SSR message");
  std::stable_sort(corrections.begin(), corrections.end(),
                   [](const auto& a, const auto& b) { return a.arrival < b.arrival; });
  return corrections;
}

void Corrections::add_file(const std::string& path, std::vector<ScheduledCorrection>* corrections) {
  if (corrections->empty()) return;
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto before = std::find_if(files_.begin(), files_.end(), [&](const File& file) {
    return file.ending == ending && file.last < corrections->front().arrival;
  });
  File* file = before != files_.end() ? &*before : nullptr;
  if (file == nullptr) {
    const std::string name = std::filesystem::path(path).filename().string();
    file = &files_.emplace_back(File{ending, {}, services_.add_stream(name)});
  }
  file->last = corrections->back().arrival;
  for (ScheduledCorrection& correction : *corrections) correction.stream = file->stream;
}

void Corrections::take(const ScheduledCorrection& correction, LogOutput* log) {
  std::visit([&](const auto& item) { take(correction, item, log); }, correction.item);
}

void Corrections::take(const ScheduledCorrection& from, const SsrMessage& message, LogOutput* log) {
  if (log == nullptr) return services_.add(from.stream, message, from.arrival);
  const CorrectionResult result = services_.take(from.stream, message, from.arrival);
  log->write(from.arrival, result.biases);
  log->write(from.arrival, result.states, result.source);
  if (result.change && changes_.size() < kMaxChanges) changes_.push_back(*result.change);
}

void Corrections::take(const ScheduledCorrection& from, const Ephemeris& ephemeris,
                       LogOutput* log) {
  services_.add(ephemeris);
  if (log == nullptr) return;
  Ephemeris sent = ephemeris;
  sent.transmission_time = transmission_time(ephemeris);
  log->write(from.arrival, sent);
}

void Corrections::report(const std::string& where, ImportReport* report) const {
  for (const UnusedCorrections& unused : unused_corrections(services_.counters())) {
    report->skip(where, unused.one, static_cast<long>(unused.count));
  }
  report->skip(where, "corrected state of a service while another one is in use",
               static_cast<long>(services_.left_out_states()));
  if (services_.services() < 2) return;
  for (const ServiceChange& change : changes_) {
    report->notes.push_back(text_of(change.time) + " " + to_text(change));
  }
  report->notes.push_back("changes from one correction service to another: " +
                          std::to_string(services_.changes()));
}

}  // namespace leonav
