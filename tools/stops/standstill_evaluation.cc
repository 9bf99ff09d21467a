#include "tools/stops/standstill_evaluation.h"

#include <algorithm>
#include <ostream>

#include "tools/common/format.h"
#include "tools/evaluate/errors.h"
#include "tools/evaluate/statistics.h"

namespace leonav {
namespace {

constexpr double kStands_m_s = 0.01;
constexpr std::size_t kListed = 10;

}  // namespace

void StopsRecorder::on_epoch(const EpochReport& report) {
  for (const ConstraintInstant& instant : report.constraints)
    asked_.push_back({instant.time, instant.standing});
}

std::vector<TrueStop> stops_of(const Track& truth, const StopsConfig& config) {
  std::vector<TrueStop> stops;
  std::optional<TrueStop> now;
  const auto close = [&] {
    if (now && seconds_between(now->end, now->begin) >= config.shortest_s) stops.push_back(*now);
    now.reset();
  };
  for (const TrackPoint& point : truth) {
    // The motion within a gap is unknown.
    if (now && seconds_between(point.time, now->end) > ErrorOptions{}.max_truth_gap_s) close();
    const bool stands = point.v_n && point.v_n->norm() < kStands_m_s;
    if (!stands) {
      close();
      continue;
    }
    if (!now) now = TrueStop{point.time, point.time};
    now->end = point.time;
  }
  close();
  return stops;
}

StopsResult evaluate_stops(const std::vector<DetectorInstant>& asked, const Track& truth,
                           const StopsConfig& config) {
  StopsResult result;
  std::vector<TrueStop> stops = stops_of(truth, config);
  std::vector<int> asked_in(stops.size()), found_in(stops.size());
  for (const DetectorInstant& instant : asked) {
    const auto point = truth_at(truth, instant.time, ErrorOptions{}.max_truth_gap_s);
    if (!point || !point->v_n) {
      ++result.without_truth;
      continue;
    }
    const double speed = point->v_n->norm();
    ++result.asked;
    if (speed > config.still_m_s && speed < config.creep_m_s) ++result.creeping;
    const bool slow = speed > kStands_m_s && speed <= config.still_m_s;
    result.slow += slow ? 1 : 0;
    result.slow_standing += slow && instant.standing ? 1 : 0;
    if (instant.standing) {
      ++result.standing;
      result.fastest_m_s = std::max(result.fastest_m_s, speed);
      if (speed > config.still_m_s) result.wrong.emplace_back(instant.time, speed);
    }
    const auto stop = std::find_if(stops.begin(), stops.end(), [&](const TrueStop& s) {
      return s.begin <= instant.time && instant.time <= s.end;
    });
    if (stop == stops.end()) continue;
    const auto place = static_cast<std::size_t>(stop - stops.begin());
    ++asked_in[place];
    if (!instant.standing) continue;
    ++found_in[place];
    if (stop->found_after_s < 0.0) stop->found_after_s = seconds_between(instant.time, stop->begin);
  }
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (asked_in[i] == 0) {  // not yet aligned: the detector did not run
      ++result.stops_not_asked;
      continue;
    }
    stops[i].found_s = seconds_between(stops[i].end, stops[i].begin) * found_in[i] / asked_in[i];
    result.stops.push_back(stops[i]);
  }
  return result;
}

void print_stops(const StopsResult& result, const StopsConfig& config, std::ostream& out) {
  double whole_s = 0.0, found_s = 0.0;
  const double share =
      100.0 * static_cast<double>(result.slow_standing) / static_cast<double>(result.slow);
  std::vector<double> after;
  std::vector<TrueStop> missed;
  for (const TrueStop& stop : result.stops) {
    whole_s += seconds_between(stop.end, stop.begin);
    found_s += stop.found_s;
    stop.found_after_s < 0.0 ? missed.push_back(stop) : after.push_back(stop.found_after_s);
  }
  out << format("instants asked      %zu, of which creeping (%.2f to %.2f m/s) %zu", result.asked,
                config.still_m_s, config.creep_m_s, result.creeping)
      << format("; %zu further ones left out: no truth\n", result.without_truth)
      << format("declared to stand   %zu; false %zu; fastest true speed at one %.3f m/s\n",
                result.standing, result.wrong.size(), result.fastest_m_s)
      << format("barely moving       %zu of %zu instants at %.2f to %.2f m/s declared to stand",
                result.slow_standing, result.slow, kStands_m_s, config.still_m_s)
      << (result.slow > 0 ? format(", %.0f %%; not called false\n", share) : "\n");
  if (result.stops.empty() && result.stops_not_asked == 0)
    out << "true stops          none: this run tells nothing of missed ones\n";
  else
    out << format("true stops          %zu of %.0f s in all; found %zu, %.0f s",
                  result.stops.size(), whole_s, after.size(), found_s)
        << format("; %zu further ones left out: the detector was not asked\n",
                  result.stops_not_asked);
  if (!after.empty())
    out << format("found after         %.1f s (median), %.1f s (last)\n", percentile(after, 0.5),
                  percentile(after, 1.0));
  for (std::size_t i = 0; i < std::min(kListed, missed.size()); ++i)
    out << format("missed              at %.1f s of the week, %.1f s long\n",
                  missed[i].begin.tow_s(), seconds_between(missed[i].end, missed[i].begin));
  for (std::size_t i = 0; i < std::min(kListed, result.wrong.size()); ++i)
    out << format("false               at %.1f s of the week, at %.3f m/s\n",
                  result.wrong[i].first.tow_s(), result.wrong[i].second);
  if (missed.size() > kListed || result.wrong.size() > kListed)
    out << format("and %zu missed, %zu false ones in all\n", missed.size(), result.wrong.size());
}

}  // namespace leonav
