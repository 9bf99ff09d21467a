#include "tools/evaluation/track.h"

#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "drivers/rtklib_pos/pos_reader.h"

namespace leonav {
namespace {

TrackPoint to_point(const TruthPoint& row) {
  return {row.time, row.position, row.v_n, {row.roll, row.pitch, row.yaw}, std::nullopt};
}

}  // namespace

Track load_truth(const std::string& path) {
  Track track;
  for (const TruthPoint& row : read_truth_csv(path).points) track.push_back(to_point(row));
  return track;
}

Track load_solution(const std::string& path) {
  Track track;
  if (looks_like_pos(path)) {
    for (const PosRow& row : read_pos(path).rows) {
      track.push_back({row.time, row.position, std::nullopt, {}, row.sigma_neu});
    }
    return track;
  }
  for (const SolutionRow& row : read_solution_csv(path).rows) {
    TrackPoint point = to_point(row.pva);
    point.sigma_neu = row.sigma_p_n;
    track.push_back(point);
  }
  return track;
}

}  // namespace leonav
