#include "tools/connect/formats/outputs/navigation_repeater.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace leonav {
namespace {

// The kinds of contents in Key.
constexpr std::size_t kEphemeris = 0, kIonosphere = 1, kDelays = 2;

bool is_near(GpsTime reference, GpsTime now, double max_age_s) {
  return std::abs(seconds_between(now, reference)) <= max_age_s;
}

// Whether it can serve at that time, of biases whether any can.
bool can_serve(const Ephemeris& ephemeris, GpsTime now) {
  return is_near(ephemeris.toe, now, EphemerisConfig().max_age_s(ephemeris.satellite.system));
}
bool can_serve(const KlobucharModel&, GpsTime) { return true; }
bool can_serve(const SignalBias& bias, GpsTime now) {
  return is_near(bias.time, now, NavigationRepeater::kMaxDelayAge_s);
}
bool can_serve(const std::vector<SignalBias>& biases, GpsTime now) {
  return std::any_of(biases.begin(), biases.end(),
                     [now](const SignalBias& bias) { return can_serve(bias, now); });
}

}  // namespace

void NavigationRepeater::remember(const Ephemeris& ephemeris, GpsTime now) {
  if (interval_s_ <= 0.0) return;
  sent_[{kEphemeris, ephemeris.satellite, ephemeris.message}] = {ephemeris, now};
}

void NavigationRepeater::remember(const KlobucharModel& model, GpsTime now) {
  if (interval_s_ <= 0.0) return;
  sent_[{kIonosphere}] = {model, now};
}

// L2C and L5 bring the same delays of a satellite, B1C and B2a some of their own each. The first of
// a message gives all of them its time: the oldest one.
void NavigationRepeater::remember(const std::vector<SignalBias>& of_satellite, GpsTime now) {
  if (interval_s_ <= 0.0 || of_satellite.empty()) return;
  Sent& sent = sent_[{kDelays, of_satellite.front().satellite}];
  std::vector<SignalBias> all;
  if (const auto* before = std::get_if<kDelays>(&sent.content)) all = *before;
  for (const SignalBias& bias : of_satellite) {
    std::erase_if(all, [&bias](const SignalBias& other) { return other.code == bias.code; });
    all.push_back(bias);
  }
  sent = {std::move(all), now};
}

int NavigationRepeater::repeat(GpsTime now) {
  // A receiver whose time was set back must not silence what it sent before.
  const auto waited_s = [now](const Sent* sent) {
    return std::abs(seconds_between(now, sent->last));
  };
  std::vector<Sent*> due;
  for (auto& [key, sent] : sent_) {
    const bool serves =
        std::visit([now](const auto& one) { return can_serve(one, now); }, sent.content);
    if (serves && waited_s(&sent) >= interval_s_) due.push_back(&sent);
  }
  std::stable_sort(due.begin(), due.end(),
                   [&waited_s](const Sent* a, const Sent* b) { return waited_s(a) > waited_s(b); });
  due.resize(std::min(due.size(), kMostAtOnce));
  for (Sent* sent : due) {
    sent->last = now;
    send(sent->content, now);
  }
  return static_cast<int>(due.size());
}

void NavigationRepeater::send(const Content& content, GpsTime now) {
  if (const auto* ephemeris = std::get_if<kEphemeris>(&content)) {
    output_->send(*ephemeris);
  } else if (const auto* model = std::get_if<kIonosphere>(&content)) {
    output_->send(*model, now);
  } else {
    std::vector<SignalBias> biases = std::get<kDelays>(content);
    std::erase_if(biases, [now](const SignalBias& bias) { return !can_serve(bias, now); });
    output_->send(std::span<const SignalBias>(biases));
  }
}

}  // namespace leonav
