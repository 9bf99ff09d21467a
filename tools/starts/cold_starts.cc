#include "tools/starts/cold_starts.h"

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>

namespace leonav {
namespace {

constexpr double kEnough_s = 1.0;  // a start that lacks less than this counts as complete

}  // namespace

std::vector<GpsTime> choose_starts(const Track& truth, int number, double seconds,
                                   std::uint64_t seed) {
  std::vector<GpsTime> chosen;
  std::mt19937_64 bits(seed);
  const double whole = seconds_between(truth.back().time, truth.front().time) - seconds;
  if (!(whole > 0.0)) throw std::runtime_error("the truth is shorter than a start's length");
  std::array<int, 4> missing;
  missing.fill(number);
  // The instants are in milliseconds, so that they are independent of the epochs' seconds.
  for (int tried = 0; tried < 1000 * number; ++tried) {
    const auto ms = static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(1e3 * whole));
    const GpsTime start = truth.front().time.plus_nanoseconds(ms * 1'000'000);
    const InitialMotion way = initial_motion_at(truth, start);
    if (way == InitialMotion::kOther || missing[static_cast<std::size_t>(way)] == 0) continue;
    --missing[static_cast<std::size_t>(way)];
    chosen.push_back(start);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

void ColdStarts::take(Channel channel, const std::vector<std::uint8_t>& data) {
  if (is_product(channel)) products_.push_back({channel, data});
  ImuSample sample;
  if (channel == Channel::kImu && decoder_.decode(data, &sample).fault == InputFault::kNone)
    move_to(sample.time);
  for (const auto& start : under_way_) start->dispatch(channel, data);
}

std::vector<StartResult> ColdStarts::finish() {
  for (const auto& start : under_way_)
    cut_short_ += seconds_between(now_, start->result().start) < seconds_ - kEnough_s ? 1 : 0;
  while (!under_way_.empty()) end_first();
  return std::move(results_);
}

void ColdStarts::move_to(GpsTime now) {
  now_ = now;
  while (!under_way_.empty() && now > under_way_.front()->result().start.plus_seconds(seconds_))
    end_first();
  for (; next_ < instants_.size() && instants_[next_] <= now; ++next_) {
    const auto told =
        given_heading_errors_.empty() ? std::nullopt : std::optional(given_heading_errors_[next_]);
    under_way_.push_back(
        std::make_unique<ColdStart>(config_, truth_, instants_[next_], products_, told));
  }
}

void ColdStarts::end_first() {
  results_.push_back(under_way_.front()->result());
  under_way_.pop_front();
}

}  // namespace leonav
