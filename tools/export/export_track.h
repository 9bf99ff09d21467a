// This unit reads the points that are exported: from solution.csv, or from SOLUTION of a log.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/csv/solution_csv.h"

namespace leonav {

// What a user chooses of the input.
struct TrackChoice {
  std::string prefix = "LEONAV_";  // of the log's channels
  bool smoothed = false;           // of a log: SMOOTHED instead of SOLUTION
  std::optional<double> rate_hz;   // at most so many points a second; nullopt: all
};

// The points in the order of time, each with a position.
struct ExportTrack {
  std::vector<SolutionRow> rows;      // times strictly increasing
  std::vector<std::string> warnings;  // one line each for people
};

// Reads solution.csv or a log; a log is recognized by its first bytes. Satellites and PDOP of a log
// are those of the last EPOCH before the solution. Throws FileError or EventLogError with file and
// remedy where the file cannot be read or has no position.
ExportTrack load_track(const std::string& path, const TrackChoice& choice);

// Returns the positions [first, last) of the parts between which the track has no position for more
// than `gap_s`, or crosses the 180th meridian; a line must join the points of one part only. A
// prediction (is_prediction) ends a part and is one by itself, so that no line is drawn of it.
struct TrackPart {
  std::size_t first = 0, last = 0;
};
std::vector<TrackPart> parts_of(std::span<const SolutionRow> rows, double gap_s);

// Returns five median intervals of the points, at least 2 s.
double default_gap_s(std::span<const SolutionRow> rows);

}  // namespace leonav
