#include "tools/import/internal/corrections.h"

#include <algorithm>

#include "drivers/text/parse.h"
#include "tools/import/internal/rtcm3_file.h"
#include "tools/import/product_schedule.h"

namespace leonav {

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
      for (const Ephemeris& e : before_first) corrections.push_back({arrival, e});
      before_first.clear();
      corrections.push_back({arrival, *message});
      has_ssr = true;
    } else if (const auto* ephemeris = std::get_if<Ephemeris>(&output)) {
      if (has_ssr) {
        corrections.push_back({corrections.back().arrival, *ephemeris});
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

void Corrections::take(const ScheduledCorrection& correction, LogOutput* log) {
  std::visit([&](const auto& item) { take(correction.arrival, item, log); }, correction.item);
}

void Corrections::take(GpsTime arrival, const SsrMessage& message, LogOutput* log) {
  store_.add(message);
  if (log == nullptr) return;
  if (has_clocks(message)) log->write(arrival, store_.states(message, arrival), source_of(message));
  log->write(arrival, biases_of(message, arrival));
}

void Corrections::take(GpsTime arrival, const Ephemeris& ephemeris, LogOutput* log) {
  store_.add(ephemeris);
  if (log == nullptr) return;
  Ephemeris sent = ephemeris;
  sent.transmission_time = transmission_time(ephemeris);
  log->write(arrival, sent);
}

void Corrections::report(const std::string& where, ImportReport* report) const {
  const CorrectionCounters& c = store_.counters();
  const std::pair<const char*, std::uint64_t> reasons[] = {
      {"corrected clock of a satellite without corrected orbit", c.without_orbit},
      {"corrected orbit of a satellite whose clock belongs to another issue", c.without_clock},
      {"correction of a broadcast message that is not there", c.without_ephemeris},
      {"correction of BeiDou whose ephemeris of B-CNAV1 is not there (let the receiver give B1C)",
       c.without_bcnav1},
      {"correction whose orbit and clock are of different solutions", c.of_other_issue},
      {"correction that is too old", c.too_old},
      {"correction that the service does not vouch for", c.not_reliable},
      {"correction in a regional frame", c.in_regional_frame}};
  for (const auto& [reason, count] : reasons) {
    report->skip(where, reason, static_cast<long>(count));
  }
}

}  // namespace leonav
