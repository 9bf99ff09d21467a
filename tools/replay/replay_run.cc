#include "tools/replay/replay_run.h"

#include <cmath>
#include <iostream>
#include <string>

#include "drivers/lcm/event_log.h"
#include "tools/common/format.h"
#include "tools/common/learned_errors_text.h"
#include "tools/replay/run_warnings.h"

namespace leonav {

ReplayRun::ReplayRun(const DaemonConfig& config, const Options& options, const JournalScan& scan)
    : prefix_(config.lcm.prefix),
      alignment_(config.navigator.alignment),
      options_(options),
      scan_(scan),
      files_(options.out_folder, options.rate_hz),
      encoder_(this, scan.output_schema),
      navigator_(config.navigator, this),
      dispatch_(&navigator_.sequencer()) {
  if (options.verify) verifier_ = std::make_unique<Verifier>(options.log, prefix_);
  for (const Decision& delivered : scan_.delivered) navigator_.record(delivered);
  for (const Decision& decision : scan_.decisions) navigator_.record(decision);
}

void ReplayRun::run() {
  EventLogReader log(options_.log);
  LogEvent event;
  std::int64_t next_progress = log.size_bytes() / 10;
  while (log.next(&event)) {
    const auto channel = channel_from_name(event.channel, prefix_);
    if (channel && is_input(*channel)) note_time(*channel, event.timestamp_us);
    if (channel && is_replayed(*channel)) dispatch_.dispatch(*channel, event.data);
    if (log.position_bytes() >= next_progress) {
      std::cerr << "leonav-replay: " << 100 * log.position_bytes() / log.size_bytes() << " %\n";
      next_progress += log.size_bytes() / 10;
    }
  }
  files_.close();
  if (verifier_ != nullptr) verifier_->finish(scan_.stopped_cleanly && !scan_.is_broken());
}

void ReplayRun::note_time(Channel channel, std::int64_t stamp_us) {
  const bool measurement = channel == Channel::kImu || channel == Channel::kGnssEpoch;
  if (measurement && !first_measurement_us_) first_measurement_us_ = stamp_us;
  if (first_measurement_us_) log_s_ = static_cast<double>(stamp_us - *first_measurement_us_) * 1e-6;
}

void ReplayRun::on_solution(const Solution& solution) {
  files_.add(solution);
  statistics_.add(solution);
  encoder_.on_solution(solution);
}

void ReplayRun::on_epoch(const EpochReport& report) {
  files_.add(report);
  statistics_.add(report);
  encoder_.on_epoch(report);
}

void ReplayRun::on_event(const Event& event) {
  files_.add(event);
  statistics_.add(event, log_s_);
  encoder_.on_event(event);
}

void ReplayRun::on_decision(const Decision& decision) {
  statistics_.add(decision);
  encoder_.on_decision(decision);
}

void ReplayRun::on_smoother(const SmootherReport& report) {
  files_.add(report);
  statistics_.add(report);
  encoder_.on_smoother(report);
}

void ReplayRun::take(Channel channel, ByteSpan bytes) {
  const auto group = output_group(channel, bytes);
  if (!group) return;
  digest_.add(*group, bytes);
  if (verifier_ != nullptr) verifier_->compare(channel, *group, bytes);
}

void ReplayRun::print_summary(std::ostream& out) {
  const auto& received = dispatch_.counters();
  for (const Channel channel : kInputChannels) {
    // Few runs begin from a checkpoint, so that the line is left out without one.
    if (channel == Channel::kCheckpoint && received.received[index_of(channel)] == 0) continue;
    out << "input " << name_of(channel) << ": " << received.received[index_of(channel)] << "\n";
    if (received.lost[index_of(channel)] > 0) {
      out << "lost before us " << name_of(channel) << ": " << received.lost[index_of(channel)]
          << "\n";
    }
  }
  const Sequencer::Counters& inputs = navigator_.sequencer().counters();
  for (std::size_t i = 0; i < inputs.rejected.size(); ++i) {
    const std::uint64_t count = inputs.rejected[i] + inputs.refused[i];
    if (count == 0) continue;
    out << "rejected " << to_string(static_cast<InputFault>(i)) << ": " << count << "\n";
  }
  statistics_.print(out);
  print_odometer(out);
  print_learned_errors(out);
  print_whole_cycles(out);
  out << "solution.csv rows: " << files_.solution_rows() << "\n";
  for (std::size_t group = 0; group < kOutputGroups.size(); ++group) {
    out << "output " << kOutputGroups[group] << ": " << digest_.messages(group) << "\n";
  }
  if (scan_.output_schema != OutputSchema::kNewest) {
    out << "outputs in schema " << static_cast<int>(scan_.output_schema)
        << ", as the journal holds them: without protection levels\n";
  }
  out << "output hash: " << digest_.hex_digest() << "\n";
}

// Prints the odometer's scale factor that the filter has estimated at the end.
void ReplayRun::print_odometer(std::ostream& out) {
  using ekf_index::kOdometerScale, ekf_index::kSize;
  const Ekf& ekf = navigator_.gnss().ekf();
  if (ekf.filter_state().vehicle.size() <= kOdometerScale) return;
  const double sigma = std::sqrt(ekf.covariance()(kSize + kOdometerScale, kSize + kOdometerScale));
  out << "odometer scale: " << 100.0 * ekf.filter_state().vehicle[kOdometerScale] << " % (1 sigma "
      << 100.0 * sigma << ")\n";
}

// Prints the errors of codes and Dopplers as the filter knew them at the end.
void ReplayRun::print_learned_errors(std::ostream& out) {
  const LearnedErrors& errors = navigator_.gnss().ekf().learned_errors();
  if (!errors.learns()) return;
  const LearnedSummary moving = errors.summary(false), standing = errors.summary(true);
  out << "learned errors of " << learned_errors_text("codes", moving.code) << "learned errors of "
      << learned_errors_text("Dopplers", moving.doppler);
  const LearnedError& code = standing.code.all;
  const LearnedError& doppler = standing.doppler.all;
  out << format("while it stands: codes %.0f %% over %.1f s, Dopplers %.0f %% over %.1f s\n",
                100.0 * code.correlated_share, code.correlation_time_s,
                100.0 * doppler.correlated_share, doppler.correlation_time_s);
}

// Prints whether the receiver's carrier arcs have been seen to differ by whole cycles.
void ReplayRun::print_whole_cycles(std::ostream& out) {
  const ArcJoiner& joiner = navigator_.gnss().ekf().arc_joiner();
  if (!joiner.has_compared()) return;
  out << format("carrier arcs that differ by whole cycles: %.0f %%\n",
                100.0 * joiner.whole_cycles_share());
}

std::vector<std::string> ReplayRun::warnings() const {
  return run_warnings(dispatch_.counters(), navigator_.sequencer().counters(), statistics_,
                      alignment_);
}

}  // namespace leonav
