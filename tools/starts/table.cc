#include "table.h"

#include <algorithm>
#include <array>
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
constexpr double kDriven_s = 15.0;

bool is_off(double error, double sigma) {
  return std::abs(error) > std::max(kFalse, kFalseSigmas * sigma);
}

}  // namespace

bool is_false(const StartResult& result) {
  if (result.aligned_after_s < 0.0) return false;
  return is_off(result.error_when_aligned, result.sigma_when_aligned) ||
         (result.error_at_30_s && is_off(*result.error_at_30_s, result.sigma_at_30_s));
}

namespace {

// A heading that was in order and was started anew all the same.
bool was_right(const StartResult& result) {
  return result.restarts > 0 && !is_off(result.error_when_noticed, result.sigma_when_noticed);
}

void print_row(Way way, std::span<const StartResult> results, std::ostream& out) {
  int number = 0, cannot = 0, in_time = 0, restarts = 0, of_right = 0, wrong = 0;
  std::vector<double> after, first, later, ratio;
  for (const StartResult& result : results) {
    if (result.way != way) continue;
    ++number;
    wrong += is_false(result) ? 1 : 0;
    restarts += result.restarts > 0 ? 1 : 0;
    of_right += was_right(result) ? 1 : 0;
    const bool aligned = result.aligned_after_s >= 0.0;
    const bool soon = aligned && result.aligned_after_s <= kInTime_s;
    // One that did all the same counts.
    cannot += !soon && cannot_align(result) ? 1 : 0;
    in_time += soon ? 1 : 0;
    if (!aligned) continue;
    after.push_back(result.aligned_after_s);
    first.push_back(result.error_when_aligned / kDegree);
    if (!result.error_at_30_s) continue;
    later.push_back(*result.error_at_30_s / kDegree);
    ratio.push_back(*result.error_at_30_s / std::max(1e-9, result.sigma_at_30_s));
  }
  if (number == 0) return;
  const int could = number - cannot;
  char line[320];
  std::snprintf(line, sizeof line,
                "%-12s  %6d  %6d  %17.0f %%  %10.1f %10.1f  %28.2f %7.2f  %19.2f %7.2f %6.1f  %9d "
                " %8d  %5d\n",
                std::string(to_string(way)).c_str(), number, cannot,
                could > 0 ? 100.0 * in_time / could : 0.0, percentile(after, 0.5),
                distribution_of(after).worst, distribution_of(first).rmse,
                distribution_of(first).worst, distribution_of(later).rmse,
                distribution_of(later).worst, distribution_of(ratio).worst, restarts, of_right,
                wrong);
  out << line;
}

constexpr double kFound = 10.0 * kDegree;

bool is_right_at_end(const StartResult& result) {
  return result.error_at_end && !is_off(*result.error_at_end, result.sigma_at_end) &&
         std::abs(*result.error_at_end) < kFound;
}

}  // namespace

int print_table(std::span<const StartResult> results, std::ostream& out) {
  out << "start         number  cannot  aligned within 30 s  after s (median, last)"
         "  heading error deg: when aligned (rms, worst)"
         "  at 30 s (rms, worst, over sigma)  restarted  of right  false\n";
  for (const Way way : {Way::kStanding, Way::kStraight, Way::kCurve, Way::kReverse})
    print_row(way, results, out);
  out << "cannot: stands for nearly all of the 30 s, and the gyros cannot find north; the share is "
         "of the others; of right: restarts of a heading that was in order\n";
  return static_cast<int>(std::count_if(results.begin(), results.end(), is_false));
}

int print_told_table(std::span<const StartResult> results, std::ostream& out) {
  out << "told off by deg  number  found wrong  of right  after s driven (median, last)  corrected "
         "unaided"
         "  not aligned at end  wrong at end  error at end deg (rms, worst)\n";
  int wrong_in_all = 0;
  constexpr std::array<double, 6> kBounds = {0.0, 10.0, 45.0, 90.0, 135.0, 180.001};
  for (std::size_t i = 0; i + 1 < kBounds.size(); ++i) {
    int number = 0, noticed = 0, of_right = 0, unaided = 0, without = 0, wrong = 0;
    std::vector<double> after, end;
    for (const StartResult& result : results) {
      const double off = std::abs(result.told_off.value_or(-1.0)) / kDegree;
      // Whoever hardly drives shows nothing.
      if (off < kBounds[i] || off >= kBounds[i + 1] || result.driven_s < kDriven_s) continue;
      ++number;
      const bool right = is_right_at_end(result);
      noticed += result.restarts > 0 ? 1 : 0;
      of_right += was_right(result) ? 1 : 0;
      unaided += result.restarts == 0 && right ? 1 : 0;
      without += result.error_at_end ? 0 : 1;
      wrong += result.error_at_end && !right ? 1 : 0;
      if (result.restarts > 0) after.push_back(result.noticed_driven_s);
      if (result.error_at_end) end.push_back(*result.error_at_end / kDegree);
    }
    if (number == 0) continue;
    wrong_in_all += wrong;
    char line[320];
    std::snprintf(
        line, sizeof line,
        "%6.0f to %5.0f  %6d  %9.0f %%  %8d  %21.1f %7.1f  %15.0f %%  %18d  %12d  %21.2f %7.2f\n",
        kBounds[i], kBounds[i + 1], number, 100.0 * noticed / number, of_right,
        percentile(after, 0.5), distribution_of(after).worst, 100.0 * unaided / number, without,
        wrong, distribution_of(end).rmse, distribution_of(end).worst);
    out << line;
  }
  return wrong_in_all;
}

}  // namespace leonav
