#include "tools/starts/heading_record.h"
#include "core/base/angle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace leonav {
namespace {

constexpr double kLeast = 5.0 * kDegree;
constexpr double kSigmas = 5.0;
constexpr double kMostJustAligned = 45.0 * kDegree;
constexpr double kMost = 15.0 * kDegree;
constexpr std::array<double, 3> kAfterAlignment_s = {0.0, 10.0, 20.0};
constexpr double kRounding_s = 0.05;     // of the epochs' times
constexpr double kRecordLater_s = 30.5;  // the last epoch until then counts as that at 30 s

// Returns whether the alignment caused an error at this instant.
bool is_of_alignment(const HeadingSample& sample) {
  return sample.since_aligned_s < kAfterAlignment_s.back() + 1.0;
}

bool is_false_alignment(const HeadingSample& sample) {
  return is_of_alignment(sample) && is_off(sample);
}

}  // namespace

bool is_off(const HeadingSample& sample) {
  const bool just_aligned = sample.since_aligned_s < kAfterAlignment_s[1] - kRounding_s;
  const double most = just_aligned ? kMostJustAligned : kMost;
  return std::abs(sample.error) > std::clamp(kSigmas * sample.sigma, kLeast, most);
}

void HeadingRecord::add(double after_s, double error, double sigma) {
  if (!aligned_after_s_) {
    aligned_after_s_ = after_s;
    next_ = 0;
  }
  const HeadingSample now{after_s, after_s - *aligned_after_s_, error, sigma};
  last_ = now;
  if (!first_) first_ = now;
  if (after_s <= kRecordLater_s) at_30_s_ = now;
  const auto is_due = [&] {
    return next_ < kAfterAlignment_s.size() &&
           now.since_aligned_s > kAfterAlignment_s[next_] - kRounding_s;
  };
  if (!is_due()) return;
  after_alignment_.push_back(now);
  while (is_due()) ++next_;
}

void HeadingRecord::add_without(double after_s) {
  aligned_after_s_.reset();
  last_.reset();
  if (after_s <= kRecordLater_s) at_30_s_.reset();
}

std::vector<HeadingSample> HeadingRecord::judged() const {
  std::vector<HeadingSample> all = after_alignment_;
  if (at_30_s_) all.push_back(*at_30_s_);
  if (last_) all.push_back(*last_);
  return all;
}

bool has_false_alignment(const HeadingRecord& record) {
  return std::ranges::any_of(record.judged(), is_false_alignment);
}

bool has_diverged(const HeadingRecord& record) {
  return !has_false_alignment(record) && first_off(record);
}

std::optional<HeadingSample> first_off(const HeadingRecord& record) {
  const std::vector<HeadingSample> judged = record.judged();
  const auto off = std::ranges::find_if(judged, is_off);
  return off == judged.end() ? std::nullopt : std::optional(*off);
}

}  // namespace leonav
