#include "tools/connect/stamps/pulse_tie.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/common/format.h"

namespace leonav {

void PulseTie::on_mark(const PulseMark& mark) {
  if (!(mark.sigma_s <= kMaxSigma_s)) {
    ++refused_;
    return;
  }
  const std::int64_t since_ns = nanoseconds_between(mark.time, last_mark_);
  if (last_mark_.is_set() && since_ns >= 0 && since_ns < PulseLine::kApart_ns) return;
  last_mark_ = mark.time;
  if (waiting_.size() == kWaiting) {
    waiting_.pop_front();
    ++unmatched_;
  }
  waiting_.push_back(mark);
}

void PulseTie::on_reading(std::int64_t clock_ns, std::optional<bool> has_pulse,
                          GpsTime by_arrivals) {
  // From the first marked sample on only marked ones may have pulses.
  if (has_pulse.value_or(false) && !marks_pulses_) {
    marks_pulses_ = true;
    restart();
  }
  if (!samples_.empty() && clock_ns < samples_.back().clock_ns) samples_.clear();
  const bool may_have_pulse = !marks_pulses_ || has_pulse.value_or(false);
  if (may_have_pulse && (samples_.empty() || clock_ns > samples_.back().clock_ns)) {
    samples_.push_back({clock_ns, by_arrivals});
    if (samples_.size() > kSamples) samples_.pop_front();
    match_waiting();
  }
}

void PulseTie::restart() {
  samples_.clear();
  waiting_.clear();
  last_mark_ = GpsTime();
  first_off_ns_.reset();
  if (line_.pulses() > 0) ++restarts_;
  line_.clear();
}

GpsTime PulseTie::time_of(const Sample& sample) const {
  return line_.holds_at(sample.clock_ns) ? line_.gps_time(sample.clock_ns) : sample.by_arrivals;
}

// A pulse is matched once a sample after it has come, so that its neighbours on both sides are
// known.
void PulseTie::match_waiting() {
  while (!waiting_.empty()) {
    const PulseMark mark = waiting_.front();
    const std::int64_t after_ns = nanoseconds_between(time_of(samples_.back()), mark.time);
    if (after_ns > -kAhead_ns && after_ns < usual_spacing_ns() / 2) return;
    waiting_.pop_front();
    match(mark);
  }
}

void PulseTie::match(const PulseMark& mark) {
  const std::int64_t spacing_ns = usual_spacing_ns();  // 0, and no sample, where it is not known
  const auto off_ns = [&](const Sample& sample) {
    return nanoseconds_between(time_of(sample), mark.time);
  };
  if (off_ns(samples_.front()) > spacing_ns) return;  // its sample came too early to be known
  const auto nearest = std::min_element(
      samples_.begin(), samples_.end(),
      [&](const Sample& a, const Sample& b) { return std::abs(off_ns(a)) < std::abs(off_ns(b)); });
  if (std::abs(off_ns(*nearest)) > spacing_ns / 2) {
    ++unmatched_;
    return;
  }
  off_ns_ = nanoseconds_between(nearest->by_arrivals, mark.time);
  if (!line_.holds_at(nearest->clock_ns)) {
    if (line_.is_ready()) line_.clear();  // held for too long
    if (!first_off_ns_ || line_.pulses() == 0) first_off_ns_ = off_ns_;
    if (std::abs(off_ns_ - *first_off_ns_) > spacing_ns / 4) {
      line_.clear();
      first_off_ns_ = off_ns_;
    }
  }
  line_.add(nearest->clock_ns, mark.time, mark.sigma_s);
}

// The median of the last times between samples that may have pulses; 0: not known yet.
std::int64_t PulseTie::usual_spacing_ns() const {
  if (samples_.size() < 3) return 0;
  std::vector<std::int64_t> spacings;
  for (std::size_t i = samples_.size() - 1; i > 0 && spacings.size() < kSpacings; --i) {
    spacings.push_back(samples_[i].clock_ns - samples_[i - 1].clock_ns);
  }
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

std::string PulseTie::text() const {
  const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::string text = leonav::format("arrivals later by %.2f ms, of +-%.2f ms that are allowed",
                                    static_cast<double>(off_ns_) * 1e-6,
                                    static_cast<double>(usual_spacing_ns()) * 0.5e-6);
  if (unmatched_ > 0) text += leonav::format(", %llu pulses of no sample", number(unmatched_));
  if (refused_ > 0) text += leonav::format(", %llu pulses too uncertain", number(refused_));
  if (restarts_ > 0) text += leonav::format(", begun anew %llu times", number(restarts_));
  return text;
}

}  // namespace leonav
