#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>
#include <vector>

#include "tools/evaluation/statistics.h"

namespace leonav {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kInTime_s = 30.0;
constexpr double kFalse = 5.0 * kDegree;
constexpr double kFalseSigmas = 5.0;

bool is_off(double error, double sigma) {
  return std::abs(error) > std::max(kFalse, kFalseSigmas * sigma);
}

}  // namespace

bool is_false(const StartResult& result) {
  if (result.aligned_after_s < 0.0) return false;
  return is_off(result.error_when_aligned, result.sigma_when_aligned) ||
         (result.error_at_30_s && is_off(*result.error_at_30_s, result.sigma_at_30_s));
}

int print_table(std::span<const StartResult> results, std::ostream& out) {
  out << "start         number  aligned within 30 s  after s (median, last)"
         "  heading error deg: when aligned (rms, worst)"
         "  at 30 s (rms, worst, over sigma)  false\n";
  int all_false = 0;
  for (const Way way : {Way::kStanding, Way::kStraight, Way::kCurve}) {
    int number = 0, in_time = 0, wrong = 0;
    std::vector<double> after, first, later, ratio;
    for (const StartResult& result : results) {
      if (result.way != way) continue;
      ++number;
      wrong += is_false(result) ? 1 : 0;
      if (result.aligned_after_s < 0.0) continue;
      in_time += result.aligned_after_s <= kInTime_s ? 1 : 0;
      after.push_back(result.aligned_after_s);
      first.push_back(result.error_when_aligned / kDegree);
      if (!result.error_at_30_s) continue;
      later.push_back(*result.error_at_30_s / kDegree);
      ratio.push_back(*result.error_at_30_s / std::max(1e-9, result.sigma_at_30_s));
    }
    if (number == 0) continue;
    all_false += wrong;
    char line[256];
    std::snprintf(line, sizeof line,
                  "%-12s  %6d  %17.0f %%  %10.1f %10.1f  %28.2f %7.2f  %19.2f %7.2f %6.1f  %5d\n",
                  std::string(to_string(way)).c_str(), number, 100.0 * in_time / number,
                  percentile(after, 0.5), distribution_of(after).worst, distribution_of(first).rmse,
                  distribution_of(first).worst, distribution_of(later).rmse,
                  distribution_of(later).worst, distribution_of(ratio).worst, wrong);
    out << line;
  }
  return all_false;
}

}  // namespace leonav
