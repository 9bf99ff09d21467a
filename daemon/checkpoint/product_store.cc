#include "daemon/checkpoint/product_store.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

#include "core/base/capacity.h"

namespace leonav {
namespace {

auto signal_of(const SignalBias& bias) { return std::tie(bias.satellite, bias.kind, bias.code); }

bool is_before(const SignalBias& a, const SignalBias& b) {
  return std::tuple(signal_of(a), a.valid_from) < std::tuple(signal_of(b), b.valid_from);
}

// What a bias is good for, least first.
enum class Use : std::uint8_t { kEnded, kAhead, kInForce };

Use use_at(GpsTime time, const SignalBias& bias) {
  const bool has_ended = bias.valid_until.is_set()
                             ? time >= bias.valid_until
                             : seconds_between(time, bias.time) > kLongestBiasAge_s;
  if (has_ended) return Use::kEnded;
  return bias.valid_from.is_set() && time < bias.valid_from ? Use::kAhead : Use::kInForce;
}

// Whether at `time` the bias `a` of a signal makes room rather than `b`.
bool makes_room(GpsTime time, const SignalBias& a, const SignalBias& b) {
  const Use use_a = use_at(time, a), use_b = use_at(time, b);
  if (use_a != use_b) return use_a < use_b;
  return use_a == Use::kAhead ? a.valid_from > b.valid_from : a.time < b.time;
}

}  // namespace

std::span<const SignalBias> first_message_of(std::span<const SignalBias> biases) {
  std::size_t count = 0;
  while (count < std::min(biases.size(), kMaxBiases) && biases[count].time == biases[0].time)
    ++count;
  return biases.first(count);
}

ProductStore::ProductStore() {
  products_.ephemerides.reserve(kMostEphemerides);
  products_.biases.reserve(kMostBiases);
}

void ProductStore::keep(const Ephemeris& ephemeris) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  std::vector<Ephemeris>& all = products_.ephemerides;
  const auto same = std::find_if(all.begin(), all.end(), [&](const Ephemeris& one) {
    return one.satellite == ephemeris.satellite && one.message == ephemeris.message;
  });
  if (same != all.end()) {
    *same = ephemeris;
  } else if (all.size() < kMostEphemerides) {
    all.push_back(ephemeris);
  }
  changed_ = true;
}

void ProductStore::keep(const KlobucharModel& ionosphere) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  products_.ionosphere = ionosphere;
  changed_ = true;
}

void ProductStore::keep(std::span<const SignalBias> biases) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || biases.empty()) return;
  if (products_.biases.size() + biases.size() > kMostBiases)
    std::erase_if(products_.biases, [now = biases[0].time](const SignalBias& bias) {
      return use_at(now, bias) == Use::kEnded;
    });
  for (const SignalBias& bias : biases) {
    if (bias.kind == BiasKind::kPhase || !is_sane(bias)) continue;
    keep_bias(bias);
    changed_ = true;
  }
}

void ProductStore::keep_bias(const SignalBias& bias) {
  std::vector<SignalBias>& all = products_.biases;
  const auto place = std::lower_bound(all.begin(), all.end(), bias, is_before);
  if (place != all.end() && !is_before(bias, *place)) {
    *place = bias;
    return;
  }
  const auto same_signal = [&](const SignalBias& one) { return signal_of(one) == signal_of(bias); };
  auto first = place;
  while (first != all.begin() && same_signal(*(first - 1))) --first;
  const auto end = std::find_if_not(place, all.end(), same_signal);
  if (static_cast<std::size_t>(end - first) < SignalBiasStore::kMaxIntervals) {
    if (all.size() < kMostBiases) all.insert(place, bias);
    return;
  }
  const auto rather = [&](const SignalBias& a, const SignalBias& b) {
    return makes_room(bias.time, a, b);
  };
  const auto last = std::min_element(first, end, rather);
  if (rather(bias, *last)) return;
  *last = bias;
  std::sort(first, end, is_before);
}

// Sorts without the lock, because what comes meanwhile would be left out.
bool ProductStore::take(BroadcastProducts* products) {
  {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(changed_, false)) return false;
    *products = products_;
  }
  std::sort(products->biases.begin(), products->biases.end(),
            [](const SignalBias& a, const SignalBias& b) {
              return a.time != b.time ? a.time < b.time : is_before(a, b);
            });
  return true;
}

}  // namespace leonav
