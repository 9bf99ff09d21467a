#include "tools/evaluate/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace leonav {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(
      std::clamp(rank - 1.0, 0.0, static_cast<double>(values.size() - 1)))];
}

Distribution distribution_of(const std::vector<double>& values) {
  Distribution d;
  d.count = values.size();
  if (values.empty()) return d;
  double sum = 0.0, squares = 0.0;
  for (double value : values) {
    sum += value;
    squares += value * value;
  }
  d.mean = sum / static_cast<double>(d.count);
  d.rmse = std::sqrt(squares / static_cast<double>(d.count));
  d.p50 = percentile(values, 0.50);
  d.p95 = percentile(values, 0.95);
  d.p99 = percentile(values, 0.99);
  d.worst = percentile(values, 1.0);
  return d;
}

std::optional<double> convergence_time_s(const std::vector<ErrorSample>& errors, double bound_m) {
  constexpr int kConsecutive = 10;
  int run = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    run = errors[i].three_d() < bound_m ? run + 1 : 0;
    if (run == kConsecutive) {
      return seconds_between(errors[i + 1 - kConsecutive].time, errors.front().time);
    }
  }
  return std::nullopt;
}

namespace {

template <typename Get>
std::vector<double> column(const std::vector<ErrorSample>& errors, Get get) {
  std::vector<double> out;
  out.reserve(errors.size());
  for (const ErrorSample& sample : errors) get(sample, &out);
  return out;
}

std::optional<Distribution> optional_distribution(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return distribution_of(values);
}

std::optional<double> share_within_three_sigma(const std::vector<ErrorSample>& errors) {
  std::size_t within = 0, total = 0;
  for (const ErrorSample& sample : errors) {
    if (!sample.sigma_neu) continue;
    for (int i = 0; i < 3; ++i) {
      ++total;
      if (std::abs(sample.neu[i]) <= 3.0 * (*sample.sigma_neu)[i]) ++within;
    }
  }
  if (total == 0) return std::nullopt;
  return static_cast<double>(within) / static_cast<double>(total);
}

std::string span_of(const Track& track) {
  const auto text = [](GpsTime time) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%d:%.1f", time.week(), time.tow_s());
    return std::string(buffer);
  };
  return text(track.front().time) + " to " + text(track.back().time);
}

// Solutions that have a time in common with the truth may all stand in holes of it.
std::string why_no_errors(const Comparison& comparison, const Track& solution, const Track& truth,
                          const ErrorOptions& options) {
  if (comparison.solution_epochs == 0)
    return "solution and truth have no common time: the solution is from " + span_of(solution) +
           ", the truth from " + span_of(truth) + " (GPS week:seconds)";
  char gap[32];
  std::snprintf(gap, sizeof gap, "%g s", options.max_truth_gap_s);
  return "no solution has truth on both sides within " + std::string(gap) +
         "; raise --max-truth-gap if the truth is that sparse";
}

}  // namespace

std::optional<double> settling_time_s(const std::vector<ErrorSample>& errors, double bound_m) {
  std::size_t settled = errors.size();
  while (settled > 0 && errors[settled - 1].three_d() < bound_m) --settled;
  if (settled == errors.size()) return std::nullopt;
  return seconds_between(errors[settled].time, errors.front().time);
}

Evaluation evaluate(const std::string& label, const Track& solution, const Track& truth,
                    const ErrorOptions& options, double convergence_bound_m) {
  Evaluation e;
  e.label = label;
  e.comparison = compare(solution, truth, options);
  const std::vector<ErrorSample>& errors = e.comparison.errors;
  if (errors.empty()) {
    throw std::runtime_error(label + ": " + why_no_errors(e.comparison, solution, truth, options));
  }
  auto component = [&](int i) {
    return column(errors, [i](const ErrorSample& s, auto* out) { out->push_back(s.neu[i]); });
  };
  auto angle = [&](std::size_t i) {
    return column(errors, [i](const ErrorSample& s, auto* out) {
      if (s.rpy[i]) out->push_back(*s.rpy[i]);
    });
  };
  e.north = distribution_of(component(0));
  e.east = distribution_of(component(1));
  e.up = distribution_of(component(2));
  e.horizontal = distribution_of(
      column(errors, [](const ErrorSample& s, auto* out) { out->push_back(s.horizontal()); }));
  e.three_d = distribution_of(
      column(errors, [](const ErrorSample& s, auto* out) { out->push_back(s.three_d()); }));
  e.speed = optional_distribution(column(errors, [](const ErrorSample& s, auto* out) {
    if (s.velocity_neu) out->push_back(s.velocity_neu->norm());
  }));
  e.roll = optional_distribution(angle(0));
  e.pitch = optional_distribution(angle(1));
  e.yaw = optional_distribution(angle(2));
  e.yaw_steady = optional_distribution(column(errors, [](const ErrorSample& s, auto* out) {
    if (s.rpy[2] && s.steady_course) out->push_back(*s.rpy[2]);
  }));
  e.yaw_from_course = std::any_of(errors.begin(), errors.end(),
                                  [](const ErrorSample& s) { return s.yaw_from_course; });
  if (e.comparison.expected_epochs > 0) {
    e.availability = static_cast<double>(e.comparison.solution_epochs) /
                     static_cast<double>(e.comparison.expected_epochs);
  }
  e.convergence_bound_m = convergence_bound_m;
  e.convergence_s = convergence_time_s(errors, convergence_bound_m);
  e.settled_s = settling_time_s(errors, convergence_bound_m);
  e.within_three_sigma = share_within_three_sigma(errors);
  return e;
}

}  // namespace leonav
