// RunStatistics counts what a run did.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "core/installation_checks/convention.h"
#include "core/navigator/interface/output_sink.h"

namespace leonav {

// RunStatistics is given all outputs of a run.
class RunStatistics {
 public:
  // One event kConventionSuspect.
  struct Suspicion {
    Convention convention = Convention::kNone;
    double value = 0.0, after_s = 0.0;
  };
  void add(const Solution& solution);
  void add(const EpochReport& report);
  void add(const Event& event, double after_s);  // s of the log, since its first measurement
  void add(const Decision& decision);
  void add(const SmootherReport& report);

  // Prints "key: value" lines.
  void print(std::ostream& out) const;
  const std::vector<Suspicion>& suspicions() const { return suspicions_; }
  std::uint64_t solutions() const { return solutions_; }
  std::uint64_t epochs() const { return epochs_; }
  std::uint64_t epochs_without_position() const { return epochs_without_position_; }
  // Returns the need of an alignment under way at the last epoch.
  const AlignmentNeed& alignment() const { return alignment_; }
  const std::map<std::string, std::uint64_t>& satellites_by_reason() const {
    return satellites_by_reason_;
  }

 private:
  void print_outages(std::ostream& out) const;

  std::vector<Suspicion> suspicions_;
  std::uint64_t solutions_ = 0, epochs_ = 0, empty_epochs_ = 0, epochs_without_position_ = 0,
                commits_ = 0, misses_ = 0, carrier_arcs_ = 0, arcs_joined_ = 0,
                smoother_commits_ = 0, smoother_misses_ = 0, keyframes_skipped_ = 0,
                smoother_iterations_ = 0, smoother_shortened_ = 0, smoother_left_to_chain_ = 0;
  double used_sum_ = 0.0;
  std::array<std::uint64_t, kSystemCount> used_of_{};
  double largest_jump_m_ = 0.0;
  // For outages of 5 s and more: the step of the filter's position at the end over its sigma, and
  // the seconds until the sigma was as before.
  std::vector<double> outage_steps_, reconverged_s_;
  AlignmentNeed alignment_;
  // Ordered maps, because they are printed in order.
  std::map<std::string, std::uint64_t> smoother_statuses_, solutions_by_source_, events_,
      satellites_by_reason_, arc_ends_, measurements_by_reason_;
};

}  // namespace leonav
