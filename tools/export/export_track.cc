#include "tools/export/export_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/decode_output.h"
#include "drivers/lcm/event_log.h"
#include "drivers/text/parse.h"
#include "drivers/text/stamp_order.h"

namespace leonav {
namespace {

constexpr std::array<char, 4> kLogSync = {'\xED', '\xA1', '\xDA', '\x01'};

bool is_log(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> start{};
  file.read(start.data(), start.size());
  return file && start == kLogSync;
}

// Decides which solutions become points. The grid is anchored to GPS time, as that of
// leonav-replay --rate. Times must increase.
class PointGrid {
 public:
  explicit PointGrid(std::optional<double> rate_hz) {
    if (rate_hz) interval_ns_ = static_cast<std::int64_t>(std::llround(1e9 / *rate_hz));
  }
  bool takes(GpsTime time) {
    if (time < next_) return false;
    if (interval_ns_ > 0) {
      next_ = GpsTime::from_nanoseconds((time.nanoseconds() / interval_ns_ + 1) * interval_ns_);
    }
    return true;
  }

 private:
  std::int64_t interval_ns_ = 0;
  GpsTime next_;
};

// LogTrack collects the solutions of a log.
class LogTrack {
 public:
  LogTrack(const std::string& path, const TrackChoice& choice)
      : path_(path),
        solution_name_(
            channel_name(choice.smoothed ? Channel::kSmoothed : Channel::kSolution, choice.prefix)),
        epoch_name_(channel_name(Channel::kEpoch, choice.prefix)),
        with_epochs_(!choice.smoothed) {}

  ExportTrack read() {
    EventLogReader reader(path_);
    LogEvent event;
    while (reader.next(&event)) {
      if (event.channel == solution_name_)
        on_solution(event);
      else if (event.channel == epoch_name_ && with_epochs_)
        on_epoch(event);
    }
    if (reader.truncated()) {
      track_.warnings.push_back(path_ + ": byte " + std::to_string(reader.position_bytes()) +
                                ": the last event is cut short and left out");
    }
    warn_of_refused();
    drop_disordered();
    if (track_.rows.empty()) throw FileError(path_, 0, why_empty());
    return std::move(track_);
  }

 private:
  void on_solution(const LogEvent& event) {
    Solution solution;
    ++solutions_;
    if (const InputFault fault = decode_output(event.data, &solution); fault != InputFault::kNone) {
      ++refused_[fault];
      return;
    }
    if (solution.source == Source::kNone) return;
    track_.rows.push_back(to_solution_row(solution, satellites_, pdop_));
  }

  void on_epoch(const LogEvent& event) {
    EpochInView epoch;
    if (decode_output(event.data, &epoch) != InputFault::kNone) return;
    satellites_ = epoch.satellites_used;
    pdop_ =
        std::isfinite(epoch.pdop) && epoch.pdop > 0.0 ? std::optional(epoch.pdop) : std::nullopt;
  }

  void warn_of_refused() {
    for (const auto& [fault, count] : refused_) {
      track_.warnings.push_back(path_ + ": " + std::to_string(count) + " messages of " +
                                solution_name_ + " are left out: " + std::string(to_string(fault)));
    }
  }

  // A wrong time excludes only itself, also one that leaps ahead.
  void drop_disordered() {
    std::vector<GpsTime> stamps;
    stamps.reserve(track_.rows.size());
    for (const SolutionRow& row : track_.rows) stamps.push_back(row.pva.time);
    const std::vector<bool> in_order = stamps_in_order(stamps);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
      if (in_order[i]) track_.rows[kept++] = track_.rows[i];
    }
    if (kept == in_order.size()) return;
    track_.warnings.push_back(path_ + ": " + std::to_string(in_order.size() - kept) +
                              " messages of " + solution_name_ +
                              " are left out: their time does not fit those around them");
    track_.rows.resize(kept);
  }

  std::string why_empty() const {
    if (solutions_ == 0) {
      return "no message on " + solution_name_ +
             "; a log of leonav-import has no solutions (leonav-replay --out DIR makes "
             "solution.csv of it), and --prefix must be lcm.prefix of the run";
    }
    const auto other = refused_.find(InputFault::kUndecodable);
    if (other != refused_.end() && other->second == solutions_) {
      return "the solutions are of another version of leonav; leonav-replay --out DIR makes "
             "solution.csv of the journal";
    }
    return "no solution has a position (" + std::to_string(solutions_) +
           " messages); leonav-replay tells why";
  }

  std::string path_, solution_name_, epoch_name_;
  bool with_epochs_;
  ExportTrack track_;
  std::optional<int> satellites_;
  std::optional<double> pdop_;
  std::map<InputFault, long> refused_;
  long solutions_ = 0;
};

ExportTrack load_csv(const std::string& path) {
  SolutionCsv csv = read_solution_csv(path);
  ExportTrack track;
  track.rows = std::move(csv.rows);
  if (csv.report.skipped > 0) {
    const std::string first = csv.report.problems.empty() ? path : csv.report.problems.front();
    track.warnings.push_back(first + " (" + std::to_string(csv.report.skipped) +
                             " rows are left out in all)");
  }
  return track;
}

}  // namespace

ExportTrack load_track(const std::string& path, const TrackChoice& choice) {
  ExportTrack track = is_log(path) ? LogTrack(path, choice).read() : load_csv(path);
  PointGrid grid(choice.rate_hz);
  std::erase_if(track.rows, [&](const SolutionRow& row) { return !grid.takes(row.pva.time); });
  return track;
}

std::vector<TrackPart> parts_of(std::span<const SolutionRow> rows, double gap_s) {
  std::vector<TrackPart> parts;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool joined = i > 0 && !is_prediction(rows[i]) && !is_prediction(rows[i - 1]) &&
                        seconds_between(rows[i].pva.time, rows[i - 1].pva.time) <= gap_s &&
                        std::abs(rows[i].pva.position.longitude -
                                 rows[i - 1].pva.position.longitude) <= std::numbers::pi;
    if (!joined) parts.push_back({i, i});
    parts.back().last = i + 1;
  }
  return parts;
}

double default_gap_s(std::span<const SolutionRow> rows) {
  constexpr double kIntervals = 5.0, kLeast_s = 2.0;
  if (rows.size() < 2) return kLeast_s;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    intervals.push_back(seconds_between(rows[i].pva.time, rows[i - 1].pva.time));
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return std::max(kIntervals * *middle, kLeast_s);
}

}  // namespace leonav
