// ReplayRun feeds one log through the Navigator, with outputs to files, digest and verifier.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/config/daemon_config.h"
#include "daemon/messages/encoding_sink.h"
#include "daemon/messages/input_dispatch.h"
#include "tools/replay/journal_scan.h"
#include "tools/replay/output_digest.h"
#include "tools/replay/result_files.h"
#include "tools/replay/run_statistics.h"
#include "tools/replay/verifier.h"

namespace leonav {

// ReplayRun owns everything that one replay needs.
class ReplayRun final : private OutputSink, private MessageTarget {
 public:
  struct Options {
    std::string log;
    std::string out_folder;
    std::optional<double> rate_hz;
    bool verify = false;
  };
  ReplayRun(const DaemonConfig& config, const Options& options, const JournalScan& scan);

  // Feeds the whole log. Throws EventLogError, FileError.
  void run();

  // Prints "key: value" lines; call it once, after run().
  void print_summary(std::ostream& out);

  // Returns the warnings for the user, empty if there are none. Precondition: run().
  std::vector<std::string> warnings() const;

  const RunStatistics& statistics() const { return statistics_; }
  long solution_rows() const { return files_.solution_rows(); }
  const Verifier* verifier() const { return verifier_.get(); }

 private:
  void note_time(Channel channel, std::int64_t stamp_us);
  void print_odometer(std::ostream& out);
  void print_learned_errors(std::ostream& out);
  void print_whole_cycles(std::ostream& out);
  void on_solution(const Solution& solution) override;
  void on_epoch(const EpochReport& report) override;
  void on_event(const Event& event) override;
  void on_decision(const Decision& decision) override;
  void on_smoother(const SmootherReport& report) override;
  void take(Channel channel, ByteSpan bytes) override;

  std::string prefix_;
  double log_s_ = 0.0;  // by the log's own stamps, since its first measurement
  std::optional<std::int64_t> first_measurement_us_;
  AlignmentConfig alignment_;
  Options options_;
  JournalScan scan_;
  ResultFiles files_;
  RunStatistics statistics_;
  OutputDigest digest_;
  std::unique_ptr<Verifier> verifier_;
  EncodingSink encoder_;
  Navigator navigator_;
  InputDispatch dispatch_;
};

}  // namespace leonav
