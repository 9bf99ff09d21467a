#include "tools/replay/run_warnings.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "daemon/text/alignment_text.h"
#include "daemon/text/convention_text.h"

namespace leonav {
namespace {

using Counts = std::vector<std::pair<std::string, std::uint64_t>>;

std::string most_frequent_first(Counts counts) {
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, count] : counts) {
    if (count == 0) continue;
    text += (text.empty() ? "" : ", ") + name + " " + std::to_string(count);
  }
  return text.empty() ? "none counted" : text;
}

// The Sequencer counts faults of all streams together.
std::string rejections(const Sequencer::Counters& accepted) {
  Counts counts;
  for (std::size_t i = 0; i < accepted.rejected.size(); ++i) {
    counts.emplace_back(to_string(static_cast<InputFault>(i)), accepted.rejected[i]);
  }
  counts.emplace_back("late", accepted.late_epochs);
  return most_frequent_first(counts);
}

std::string share(std::uint64_t part, std::uint64_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole);
}

bool is_most(std::uint64_t part, std::uint64_t whole) { return 2 * part > whole; }

}  // namespace

std::vector<std::string> run_warnings(const InputDispatch::Counters& received,
                                      const Sequencer::Counters& accepted,
                                      const RunStatistics& statistics,
                                      const AlignmentConfig& alignment) {
  std::vector<std::string> warnings;
  const auto compare = [&](Channel channel, std::uint64_t used) {
    const std::uint64_t count = received.received[index_of(channel)];
    const std::uint64_t unused = count - std::min(count, used);
    if (!is_most(unused, count)) return;
    warnings.push_back(share(unused, count) + " " + std::string(name_of(channel)) +
                       " messages were not used; rejected inputs: " + rejections(accepted));
  };
  compare(Channel::kImu, accepted.imu);
  compare(Channel::kGnssEpoch, accepted.epochs);
  compare(Channel::kEphemeris, accepted.ephemerides);
  if (is_most(statistics.epochs_without_position(), statistics.epochs())) {
    const auto& reasons = statistics.satellites_by_reason();
    warnings.push_back(share(statistics.epochs_without_position(), statistics.epochs()) +
                       " epochs gave no position; satellites: " +
                       most_frequent_first(Counts(reasons.begin(), reasons.end())));
  }
  for (const RunStatistics::Suspicion& suspicion : statistics.suspicions()) {
    char after[48];
    std::snprintf(after, sizeof after, "after %.0f s: ", suspicion.after_s);
    warnings.push_back("convention_suspect " + std::string(to_string(suspicion.convention)) + " " +
                       after + convention_text(suspicion.convention, suspicion.value));
  }
  const AlignmentText lacks = to_text(statistics.alignment(), alignment);
  if (!lacks.empty())
    warnings.push_back("the run ends while aligning: " + std::string(lacks.data(), lacks.size()));
  return warnings;
}

}  // namespace leonav
