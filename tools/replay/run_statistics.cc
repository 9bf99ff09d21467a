#include "tools/replay/run_statistics.h"

#include <algorithm>

#include "drivers/csv/solution_csv.h"

namespace leonav {
namespace {

// The event's code is in tenths of a sigma, in one byte.
constexpr double kLargestStepTold = 25.5;

void print_map(std::ostream& out, const std::string& title,
               const std::map<std::string, std::uint64_t>& counts) {
  for (const auto& [name, count] : counts) out << title << " " << name << ": " << count << "\n";
}

}  // namespace

void RunStatistics::add(const Solution& solution) {
  ++solutions_;
  ++solutions_by_source_[std::string(source_name(solution.source, solution.has_attitude))];
  largest_jump_m_ = std::max(largest_jump_m_, solution.jump_m);
}

void RunStatistics::add(const EpochReport& report) {
  ++epochs_;
  if (report.empty) ++empty_epochs_;
  alignment_ = report.alignment;
  if (report.solution.source == Source::kNone) ++epochs_without_position_;
  used_sum_ += report.satellites_used;
  arcs_joined_ += static_cast<std::uint64_t>(report.arcs_joined);
  for (const SatelliteReport& satellite : report.satellites) {
    used_of_[index_of(satellite.satellite.system)] += satellite.reason == Reason::kUsed ? 1 : 0;
    ++satellites_by_reason_[std::string(to_string(satellite.reason))];
    if (!satellite.arc_started) continue;
    ++carrier_arcs_;
    for (const SlipCause cause : kSlipCauses)
      if (satellite.arc_causes.has(cause)) ++arc_ends_[std::string(to_string(cause))];
  }
  for (const AidingReport& aiding : report.aiding) {
    ++measurements_by_reason_[std::string(to_string(aiding.reason))];
  }
}

void RunStatistics::add(const Event& event, double after_s) {
  std::string name(to_string(event.kind));
  if (event.kind == EventKind::kRejectedInput) {
    name += " " + std::string(to_string(static_cast<InputFault>(event.code)));
  }
  if (event.kind == EventKind::kConventionSuspect) {
    name += " " + std::string(to_string(static_cast<Convention>(event.code)));
    suspicions_.push_back({static_cast<Convention>(event.code), event.value, after_s});
  }
  ++events_[name];
  if (event.kind == EventKind::kOutageOver) outage_steps_.push_back(event.code / 10.0);
  if (event.kind == EventKind::kReconverged) reconverged_s_.push_back(event.value);
}

void RunStatistics::add(const Decision& decision) {
  if (decision.subject == Decision::Subject::kFilter) ++(decision.committed ? commits_ : misses_);
  if (decision.subject == Decision::Subject::kSmoother)
    ++(decision.committed ? smoother_commits_ : smoother_misses_);
  if (decision.subject == Decision::Subject::kKeyframe) ++keyframes_skipped_;
}

void RunStatistics::add(const SmootherReport& report) {
  ++smoother_statuses_[std::string(to_string(report.status))];
  smoother_iterations_ += static_cast<std::uint64_t>(report.iterations);
  smoother_shortened_ += static_cast<std::uint64_t>(report.shortened);
  smoother_left_to_chain_ += report.left_to_chain ? 1 : 0;
}

void RunStatistics::print(std::ostream& out) const {
  out << "solutions: " << solutions_ << "\n";
  print_map(out, "solutions by source", solutions_by_source_);
  out << "epochs: " << epochs_ << "\nempty epochs: " << empty_epochs_ << "\n"
      << "results committed: " << commits_ << "\ndeadline misses: " << misses_ << "\n";
  if (!smoother_statuses_.empty()) {
    out << "smoother decisions in time: " << smoother_commits_
        << "\nsmoother deadline misses: " << smoother_misses_
        << "\nkeyframes skipped: " << keyframes_skipped_
        << "\nsmoother iterations: " << smoother_iterations_ << "\n";
    if (smoother_shortened_ > 0) out << "smoother steps shortened: " << smoother_shortened_ << "\n";
    if (smoother_left_to_chain_ > 0)
      out << "smoother solves that Ceres left to the chain: " << smoother_left_to_chain_ << "\n";
    print_map(out, "smoother results", smoother_statuses_);
  }
  if (epochs_ > 0) {
    out << "mean satellites used: " << used_sum_ / static_cast<double>(epochs_) << "\n";
    for (const System system : kSystems)
      if (used_of_[index_of(system)] > 0)
        out << "mean satellites used of " << to_string(system) << ": "
            << static_cast<double>(used_of_[index_of(system)]) / static_cast<double>(epochs_)
            << "\n";
  }
  out << "largest jump m: " << largest_jump_m_ << "\n";
  print_outages(out);
  print_map(out, "satellites", satellites_by_reason_);
  print_map(out, "measurements", measurements_by_reason_);
  out << "carrier arcs: " << carrier_arcs_ << "\n";
  if (arcs_joined_ > 0) out << "carrier arcs joined to the one before: " << arcs_joined_ << "\n";
  print_map(out, "carrier arcs ended by", arc_ends_);
  print_map(out, "events", events_);
}

void RunStatistics::print_outages(std::ostream& out) const {
  if (!outage_steps_.empty()) {
    const double largest = *std::max_element(outage_steps_.begin(), outage_steps_.end());
    out << "outages: " << outage_steps_.size()
        << "\nlargest step after one, in its sigmas: " << (largest >= kLargestStepTold ? ">= " : "")
        << largest << "\nreconverged: " << reconverged_s_.size() << " of " << outage_steps_.size()
        << "\n";
  }
  if (!reconverged_s_.empty())
    out << "longest time to the sigma of before s: "
        << *std::max_element(reconverged_s_.begin(), reconverged_s_.end()) << "\n";
}

}  // namespace leonav
