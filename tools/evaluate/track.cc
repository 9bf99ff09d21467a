#include "tools/evaluate/track.h"

#include <cmath>

#include "core/base/angle.h"
#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "drivers/rtklib_pos/pos_reader.h"
#include "drivers/text/parse.h"
#include "tools/common/arguments.h"

namespace leonav {
namespace {

TrackPoint to_point(const TruthPoint& row) {
  return {row.time, row.position, row.v_n, {row.roll, row.pitch, row.yaw}, std::nullopt, {}, {}};
}

void report(const CsvReport& csv, SkippedRows* skipped) {
  if (skipped == nullptr) return;
  *skipped = {csv.skipped, csv.rows, csv.problems.empty() ? "" : csv.problems.front()};
}

Track load_pos(const std::string& path, SkippedRows* skipped) {
  Track track;
  const PosFile pos = read_pos(path);
  for (const PosRow& row : pos.rows)
    track.push_back({row.time, row.position, std::nullopt, {}, row.sigma_neu, {}, {}});
  if (skipped != nullptr && pos.skipped > 0) {
    *skipped = {pos.skipped, static_cast<long>(pos.rows.size()),
                path + ":" + std::to_string(pos.first_skipped_line) +
                    ": is no solution, or its time does not fit those around it"};
  }
  return track;
}

}  // namespace

TrackPoint surveyed_point(const std::string& text) {
  std::array<double, 3> values{};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t end = i + 1 < values.size() ? text.find(',', begin) : text.size();
    const auto value =
        end == std::string::npos ? std::nullopt : parse_double(text.substr(begin, end - begin));
    const double limit = i == 0 ? 90.0 : i == 1 ? 360.0 : 1e5;
    if (!value || !(std::abs(*value) <= limit))
      throw UsageError(
          "--truth-point needs LATITUDE,LONGITUDE,HEIGHT in degrees and metres, not '" + text +
          "'");
    values[i] = *value;
    begin = end + 1;
  }
  TrackPoint point;
  point.position = {values[0] * kDegree, values[1] * kDegree, values[2]};
  point.v_n = Eigen::Vector3d::Zero();
  return point;
}

Track standing_at(const TrackPoint& point, const Track& solution) {
  Track track = {point, point};
  track.front().time = solution.front().time.plus_seconds(-1.0);
  track.back().time = solution.back().time.plus_seconds(1.0);
  return track;
}

Track load_truth(const std::string& path, SkippedRows* skipped) {
  if (looks_like_pos(path)) {
    Track track = load_pos(path, skipped);
    // The sigmas of the truth are no part of a comparison.
    for (TrackPoint& point : track) point.sigma_neu.reset();
    return track;
  }
  Track track;
  const TruthCsv truth = read_truth_csv(path);
  for (const TruthPoint& row : truth.points) track.push_back(to_point(row));
  report(truth.report, skipped);
  return track;
}

Track load_solution(const std::string& path, SkippedRows* skipped) {
  if (looks_like_pos(path)) return load_pos(path, skipped);
  Track track;
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
