// This unit reads the real-time corrections of a recording and makes corrected states of them, as a
// live system would have.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "tools/import/correction_services.h"
#include "tools/import/import_report.h"
#include "tools/import/log_output.h"

namespace leonav {

// An item of a stream of corrections with its arrival.
struct ScheduledCorrection {
  GpsTime arrival;
  std::variant<SsrMessage, Ephemeris> item;
  std::size_t stream = 0;  // of CorrectionServices
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
  explicit Corrections(const CorrectionOptions& options) : services_(options) {}

  // Takes a file's corrections, in order of arrival, and numbers their stream: that of a file of
  // the same kind that ends before they begin, because recordings come in pieces, otherwise one of
  // their own. Services are preferred in the order of these calls.
  void add_file(const std::string& path, std::vector<ScheduledCorrection>* corrections);
  void add(const Ephemeris& ephemeris) { services_.add(ephemeris); }
  // Takes what arrives; writes what it makes where `log` is given.
  void take(const ScheduledCorrection& correction, LogOutput* log);
  // Reports the satellites of which no state could be made, and of several services which was used.
  void report(const std::string& where, ImportReport* report) const;

 private:
  struct File {
    std::string ending;  // of its name
    GpsTime last;        // arrival
    std::size_t stream = 0;
  };
  void take(const ScheduledCorrection& from, const SsrMessage& message, LogOutput* log);
  void take(const ScheduledCorrection& from, const Ephemeris& ephemeris, LogOutput* log);

  CorrectionServices services_;
  std::vector<File> files_;             // the last one of each stream
  std::vector<ServiceChange> changes_;  // up to kMaxChanges
};

}  // namespace leonav
