#include "tools/evaluate/integrity.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace leonav {
namespace {

void count(const LevelSample& sample, AlertLimitCounts* counts) {
  if (sample.level > counts->limit_m)
    ++(sample.is_misleading() ? counts->unavailable_misleading : counts->unavailable);
  else if (!sample.is_misleading())
    ++counts->nominal;
  else
    ++(sample.error > counts->limit_m ? counts->hazardous : counts->misleading);
}

bool is_hazardous(const LevelSample& sample, double limit_m) {
  return sample.level <= limit_m && sample.error > limit_m;
}

// Returns the error in tenths of its sigma, rounded down; nullopt where no sigma is stated.
std::optional<int> tenths_of_sigma(const LevelSample& sample) {
  if (!sample.sigma) return std::nullopt;
  constexpr double kMostTenths = 1e6;  // a sigma may be 0
  return static_cast<int>(std::min(kMostTenths, std::floor(10.0 * sample.error / *sample.sigma)));
}

// Counts a block once where any of its epochs is misleading or hazardous, and by its largest
// multiple of sigma.
void count_block(const LevelSample* begin, const LevelSample* end, IntegrityCounts* counts) {
  ++counts->blocks;
  const auto any = [&](auto is) { return std::any_of(begin, end, is) ? 1U : 0U; };
  counts->misleading_blocks += any([](const LevelSample& s) { return s.is_misleading(); });
  for (AlertLimitCounts& limit : counts->limits)
    limit.hazardous_blocks +=
        any([&](const LevelSample& s) { return is_hazardous(s, limit.limit_m); });
  std::optional<int> largest;  // nothing is smaller than an empty one
  for (const LevelSample* s = begin; s != end; ++s)
    largest = std::max(largest, tenths_of_sigma(*s));
  if (largest) ++counts->multiples[*largest].blocks;
}

std::int64_t block_of(const LevelSample& sample, double block_s) {
  return sample.time.nanoseconds() / std::llround(block_s * 1e9);
}

void count_blocks(const std::vector<LevelSample>& samples, double block_s,
                  IntegrityCounts* counts) {
  const LevelSample* begin = samples.data();
  const LevelSample* const last = begin + samples.size();
  while (begin != last) {
    const LevelSample* end = begin;
    while (end != last && block_of(*end, block_s) == block_of(*begin, block_s)) ++end;
    count_block(begin, end, counts);
    begin = end;
  }
}

void add(const AlertLimitCounts& from, AlertLimitCounts* to) {
  to->nominal += from.nominal;
  to->misleading += from.misleading;
  to->hazardous += from.hazardous;
  to->unavailable += from.unavailable;
  to->unavailable_misleading += from.unavailable_misleading;
  to->hazardous_blocks += from.hazardous_blocks;
}

void add(const IntegrityCounts& from, IntegrityCounts* to) {
  to->expected += from.expected;
  to->epochs += from.epochs;
  to->misleading += from.misleading;
  to->blocks += from.blocks;
  to->misleading_blocks += from.misleading_blocks;
  to->largest_ratio = std::max(to->largest_ratio, from.largest_ratio);
  to->observed_s += from.observed_s;
  for (const auto& [tenths, counts] : from.multiples) {
    to->multiples[tenths].epochs += counts.epochs;
    to->multiples[tenths].blocks += counts.blocks;
  }
  for (const auto& [bins, epochs] : from.diagram) to->diagram[bins] += epochs;
  for (std::size_t i = 0; i < to->limits.size(); ++i) add(from.limits.at(i), &to->limits[i]);
}

}  // namespace

int diagram_bin(double metres) {
  constexpr double kSmallest_m = 0.001, kBinsPerDecade = 20.0, kLast = 239.0;
  const double bin = std::floor(kBinsPerDecade * std::log10(metres / kSmallest_m));
  return static_cast<int>(std::clamp(bin, 0.0, kLast));
}

std::vector<LevelSample> horizontal_samples(const std::vector<ErrorSample>& errors) {
  std::vector<LevelSample> samples;
  for (const ErrorSample& error : errors) {
    if (!error.levels.horizontal_m) continue;
    samples.push_back({error.time, error.horizontal(), *error.levels.horizontal_m, {}});
    if (error.sigma_neu) samples.back().sigma = error.sigma_neu->head<2>().norm();
  }
  return samples;
}

std::vector<LevelSample> vertical_samples(const std::vector<ErrorSample>& errors) {
  std::vector<LevelSample> samples;
  for (const ErrorSample& error : errors) {
    if (!error.levels.vertical_m) continue;
    samples.push_back({error.time, std::abs(error.neu.z()), *error.levels.vertical_m, {}});
    if (error.sigma_neu) samples.back().sigma = error.sigma_neu->z();
  }
  return samples;
}

std::vector<LevelSample> heading_samples(const std::vector<ErrorSample>& errors) {
  std::vector<LevelSample> samples;
  for (const ErrorSample& error : errors)
    if (error.levels.heading && error.rpy[2] && !error.yaw_from_course)
      samples.push_back(
          {error.time, std::abs(*error.rpy[2]), *error.levels.heading, error.sigma_yaw});
  return samples;
}

IntegrityCounts count_integrity(const std::vector<LevelSample>& samples,
                                const std::vector<double>& limits_m, double block_s) {
  IntegrityCounts counts;
  for (const double limit_m : limits_m) counts.limits.emplace_back().limit_m = limit_m;
  counts.expected = counts.epochs = samples.size();
  for (const LevelSample& sample : samples) {
    counts.misleading += sample.is_misleading() ? 1 : 0;
    if (sample.level > 0.0)
      counts.largest_ratio = std::max(counts.largest_ratio, sample.error / sample.level);
    if (const auto tenths = tenths_of_sigma(sample)) ++counts.multiples[*tenths].epochs;
    if (!limits_m.empty()) ++counts.diagram[{diagram_bin(sample.error), diagram_bin(sample.level)}];
    for (AlertLimitCounts& limit : counts.limits) count(sample, &limit);
  }
  count_blocks(samples, block_s, &counts);
  return counts;
}

IntegrityEvaluation evaluate_integrity(const std::string& label, const Comparison& comparison,
                                       const IntegrityOptions& options) {
  const std::vector<ErrorSample>& errors = comparison.errors;
  const auto& limits = options.alert_limits_m;
  IntegrityEvaluation evaluation;
  evaluation.label = label;
  evaluation.horizontal = count_integrity(horizontal_samples(errors), limits, options.block_s);
  evaluation.vertical = count_integrity(vertical_samples(errors), limits, options.block_s);
  evaluation.heading = count_integrity(heading_samples(errors), {}, options.block_s);
  if (evaluation.horizontal.epochs == 0)
    throw std::runtime_error(label + ": states no protection level where there is a truth");
  const std::size_t with_truth =
      comparison.expected_epochs - std::min(comparison.expected_epochs, comparison.without_truth);
  for (IntegrityCounts* counts : {&evaluation.horizontal, &evaluation.vertical})
    counts->expected = std::max(counts->epochs, with_truth);
  for (auto* counts : {&evaluation.horizontal, &evaluation.vertical, &evaluation.heading})
    counts->observed_s = static_cast<double>(counts->epochs) * comparison.interval_s;
  return evaluation;
}

void add_counts(const IntegrityEvaluation& from, IntegrityEvaluation* to) {
  add(from.horizontal, &to->horizontal);
  add(from.vertical, &to->vertical);
  add(from.heading, &to->heading);
}

}  // namespace leonav
