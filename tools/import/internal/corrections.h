// This unit reads the real-time corrections of a recording and makes corrected states of them, as a
// live system would have.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "drivers/ssr/correction_store.h"
#include "tools/import/import_report.h"
#include "tools/import/log_output.h"

namespace leonav {

// An item of a stream of corrections with its arrival.
struct ScheduledCorrection {
  GpsTime arrival;
  std::variant<SsrMessage, Ephemeris> item;
};

// Reads the SSR messages and ephemerides of a file, in order of arrival: a message comes
// `latency_s` after its time, an ephemeris with the message before it. What else the file holds is
// counted in `report`. Throws FileError for a file that cannot be read, without a date, or without
// corrections.
std::vector<ScheduledCorrection> read_corrections(const std::string& path, GpsTime date,
                                                  double latency_s, ImportReport* report);

// Corrections turns messages into states and biases, in order of arrival.
class Corrections {
 public:
  explicit Corrections(const CorrectionOptions& options) : store_(options) {}

  void add(const Ephemeris& ephemeris) { store_.add(ephemeris); }
  // Takes what arrives; writes what it makes where `log` is given.
  void take(const ScheduledCorrection& correction, LogOutput* log);
  // Reports the satellites of which no state could be made.
  void report(const std::string& where, ImportReport* report) const;

 private:
  void take(GpsTime arrival, const SsrMessage& message, LogOutput* log);
  void take(GpsTime arrival, const Ephemeris& ephemeris, LogOutput* log);

  CorrectionStore store_;
};

}  // namespace leonav
