#include "tools/starts/start_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/angle.h"
#include "tools/common/format.h"
#include "tools/evaluate/statistics.h"

namespace leonav {
namespace {

constexpr double kInTime_s = 30.0;
constexpr double kDriven_s = 15.0;

// Returns whether a right heading was nevertheless started anew.
bool was_right(const StartResult& result) {
  return result.when_noticed && !is_off(*result.when_noticed);
}

// Returns "-" for a share of nothing.
std::string percent(int part, int whole) {
  return whole > 0 ? format("%.0f %%", 100.0 * part / whole) : "-";
}

void print_row(InitialMotion way, std::span<const StartResult> results, std::ostream& out) {
  int number = 0, cannot = 0, in_time = 0, restarts = 0, of_right = 0, wrong = 0, carried = 0;
  std::vector<double> after, first, later, ratio;
  for (const StartResult& result : results) {
    if (result.way != way) continue;
    ++number;
    wrong += has_false_alignment(result.heading) ? 1 : 0;
    carried += has_diverged(result.heading) ? 1 : 0;
    restarts += result.restarts > 0 ? 1 : 0;
    of_right += was_right(result) ? 1 : 0;
    const auto& aligned = result.heading.first();
    const bool soon = aligned && aligned->after_s <= kInTime_s;
    // A start that aligned nevertheless counts.
    cannot += !soon && cannot_align(result) ? 1 : 0;
    in_time += soon ? 1 : 0;
    if (!aligned) continue;
    after.push_back(aligned->after_s);
    first.push_back(aligned->error / kDegree);
    const auto& at_30_s = result.heading.at_30_s();
    if (!at_30_s) continue;
    later.push_back(at_30_s->error / kDegree);
    ratio.push_back(at_30_s->error / std::max(1e-9, at_30_s->sigma));
  }
  if (number == 0) return;
  out << format(
      "%-12s  %6d  %6d  %20s  %11s  %10.1f %10.1f  %28.2f %7.2f  %19.2f %7.2f %6.1f  %9d  %8d  %5d "
      " %12d\n",
      std::string(to_string(way)).c_str(), number, cannot, percent(in_time, number).c_str(),
      percent(in_time, number - cannot).c_str(), percentile(after, 0.5),
      distribution_of(after).worst, distribution_of(first).rmse, distribution_of(first).worst,
      distribution_of(later).rmse, distribution_of(later).worst, distribution_of(ratio).worst,
      restarts, of_right, wrong, carried);
}

constexpr double kFound = 10.0 * kDegree;

bool is_right_at_end(const StartResult& result) {
  const auto& end = result.heading.last();
  return end && !is_off(*end) && std::abs(end->error) < kFound;
}

}  // namespace

int print_table(std::span<const StartResult> results, std::ostream& out) {
  out << "start         number  cannot  aligned in 30 s, all  of the able  after s (median, last)"
         "  heading error deg: when aligned (rms, worst)"
         "  at 30 s (rms, worst, over sigma)  restarted  of right  false  carried away\n";
  for (const InitialMotion way : {InitialMotion::kStanding, InitialMotion::kStraight,
                                  InitialMotion::kCurve, InitialMotion::kReverse})
    print_row(way, results, out);
  out << "cannot: no GNSS for nearly all of the 30 s, or it stands and the gyros cannot find\n"
         "north; the able: all others; of right: restarts of a heading that was in order\n"
         "false: off when aligned or within 20 s of it; carried away: aligned rightly, off at 30 s "
         "or at the end. Off: beyond 5 degrees and 5 sigmas, which excuse at most 15 degrees "
         "(within 10 s of an alignment: 45)\n";
  return static_cast<int>(std::ranges::count_if(results, [](const StartResult& result) {
    return has_false_alignment(result.heading) || has_diverged(result.heading);
  }));
}

int print_given_heading_table(std::span<const StartResult> results, std::ostream& out) {
  out << "told off by deg  number  found wrong  of right  after s driven (median, last)  corrected "
         "unaided"
         "  not aligned at end  wrong at end  error at end deg (rms, worst)\n";
  int wrong_in_all = 0;
  constexpr std::array<double, 6> kBounds = {0.0, 10.0, 45.0, 90.0, 135.0, 180.001};
  for (std::size_t i = 0; i + 1 < kBounds.size(); ++i) {
    int number = 0, noticed = 0, of_right = 0, unaided = 0, without = 0, wrong = 0;
    std::vector<double> after, end;
    for (const StartResult& result : results) {
      const double off = std::abs(result.given_heading_error.value_or(-1.0)) / kDegree;
      // A start that hardly drives shows nothing.
      if (off < kBounds[i] || off >= kBounds[i + 1] || result.driven_s < kDriven_s) continue;
      ++number;
      const bool right = is_right_at_end(result);
      noticed += result.restarts > 0 ? 1 : 0;
      of_right += was_right(result) ? 1 : 0;
      unaided += result.restarts == 0 && right ? 1 : 0;
      const auto& last = result.heading.last();
      without += last ? 0 : 1;
      wrong += last && !right ? 1 : 0;
      if (result.restarts > 0) after.push_back(result.noticed_driven_s);
      if (last) end.push_back(last->error / kDegree);
    }
    if (number == 0) continue;
    wrong_in_all += wrong;
    out << format(
        "%6.0f to %5.0f  %6d  %9.0f %%  %8d  %21.1f %7.1f  %15.0f %%  %18d  %12d  %21.2f %7.2f\n",
        kBounds[i], kBounds[i + 1], number, 100.0 * noticed / number, of_right,
        percentile(after, 0.5), distribution_of(after).worst, 100.0 * unaided / number, without,
        wrong, distribution_of(end).rmse, distribution_of(end).worst);
  }
  return wrong_in_all;
}

}  // namespace leonav
