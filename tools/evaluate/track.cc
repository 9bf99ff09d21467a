#include "tools/evaluate/track.h"

#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "drivers/rtklib_pos/pos_reader.h"

namespace leonav {
namespace {

TrackPoint to_point(const TruthPoint& row) {
  return {row.time, row.position, row.v_n, {row.roll, row.pitch, row.yaw}, std::nullopt, {}, {}};
}

void report(const CsvReport& csv, SkippedRows* skipped) {
  if (skipped == nullptr) return;
  *skipped = {csv.skipped, csv.rows, csv.problems.empty() ? "" : csv.problems.front()};
}

}  // namespace

Track load_truth(const std::string& path, SkippedRows* skipped) {
  Track track;
  const TruthCsv truth = read_truth_csv(path);
  for (const TruthPoint& row : truth.points) track.push_back(to_point(row));
  report(truth.report, skipped);
  return track;
}

Track load_solution(const std::string& path, SkippedRows* skipped) {
  Track track;
  if (looks_like_pos(path)) {
    const PosFile pos = read_pos(path);
    for (const PosRow& row : pos.rows) {
      track.push_back({row.time, row.position, std::nullopt, {}, row.sigma_neu, {}, {}});
    }
    if (skipped != nullptr && pos.skipped > 0) {
      *skipped = {pos.skipped, static_cast<long>(pos.rows.size()),
                  path + ":" + std::to_string(pos.first_skipped_line) +
                      ": is no solution, or its time does not fit those around it"};
    }
    return track;
  }
  const SolutionCsv solution = read_solution_csv(path);
  for (const SolutionRow& row : solution.rows) {
    TrackPoint point = to_point(row.pva);
    point.sigma_neu = row.sigma_p_n;
    if (row.sigma_rpy) point.sigma_yaw = row.sigma_rpy->z();
    point.levels = {row.horizontal_protection_m, row.vertical_protection_m, row.heading_protection};
    track.push_back(point);
  }
  report(solution.report, skipped);
  return track;
}

std::string to_string(const SkippedRows& skipped) {
  if (skipped.skipped == 0) return "";
  return "WARNING: " + std::to_string(skipped.skipped) + " of " +
         std::to_string(skipped.skipped + skipped.rows) +
         " rows were skipped, the first: " + skipped.first_problem + "\n";
}

}  // namespace leonav
