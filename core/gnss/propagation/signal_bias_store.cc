#include "core/gnss/propagation/signal_bias_store.h"

#include <algorithm>
#include <cmath>

#include "core/base/capacity.h"
#include "core/base/pooled_lists.h"
#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

// 1 sigma of the bias of one signal: estimated biases agree between analysis centres to 0.1 to 0.3
// ns (IGS multi-GNSS experiment).
constexpr double kBiasSigma = 0.06;  // m

// 1 sigma of a delay in CNAV: half a nanosecond, as that of the TGD (IS-GPS-200 20.3.3.3.3.2).
constexpr double kBroadcastSigma = 0.15;  // m

struct Stored {
  SignalCode code;
  GpsTime time, valid_from, valid_until;
  double bias_m = 0.0;
  std::uint64_t arrival = 0;
  mutable GpsTime used;
};

template <std::size_t kLongest, std::size_t kAll>
using Biases = PooledLists<Stored, kMaxEphemerisSatellites, kLongest, kAll>;

bool has_ended(const Stored& stored, GpsTime time) {
  return stored.valid_until.is_set() && time >= stored.valid_until;
}

bool holds(const Stored& stored, GpsTime time) {
  if (stored.valid_from.is_set() && time < stored.valid_from) return false;
  if (stored.valid_until.is_set()) return !has_ended(stored, time);
  return std::abs(seconds_between(time, stored.time)) <= kLongestBiasAge_s;
}

template <std::size_t kLongest, std::size_t kAll>
const Stored* find(const Biases<kLongest, kAll>& biases, SatelliteId satellite, SignalCode code,
                   GpsTime time) {
  const Stored* newest = nullptr;
  for (const Stored& stored : biases[table_index_of(satellite)]) {
    if (stored.code != code || !holds(stored, time)) continue;
    if (newest == nullptr || stored.arrival > newest->arrival) newest = &stored;
  }
  return newest;
}

// Returns the slot for a bias: that of the same signal and beginning, a free one, or one of another
// bias.
template <std::size_t kLongest, std::size_t kAll>
Stored& slot_for(const SignalBias& bias, Biases<kLongest, kAll>* biases) {
  const std::size_t satellite = table_index_of(bias.satellite);
  const auto stored = (*biases)[satellite];
  const auto same = std::find_if(stored.begin(), stored.end(), [&](const Stored& s) {
    return s.code == bias.code && s.valid_from == bias.valid_from;
  });
  if (same != stored.end()) return *same;
  if (!biases->is_full(satellite)) return biases->append(satellite);
  return *std::min_element(stored.begin(), stored.end(), [&](const Stored& a, const Stored& b) {
    const bool a_ended = has_ended(a, bias.time), b_ended = has_ended(b, bias.time);
    return a_ended != b_ended ? a_ended : biases->makes_room(a, b);
  });
}

template <std::size_t kLongest, std::size_t kAll>
void keep(const SignalBias& bias, std::uint64_t arrival, Biases<kLongest, kAll>* biases) {
  Stored& slot = slot_for(bias, biases);
  // A bias that is sent again stays in use.
  const bool is_same = slot.code == bias.code && slot.valid_from == bias.valid_from;
  const GpsTime used = is_same ? slot.used : GpsTime();
  slot = {bias.code, bias.time, bias.valid_from, bias.valid_until, bias.bias_m, arrival, used};
}

template <std::size_t kLongest, std::size_t kAll>
std::optional<GroupDelay> delay_of(const Biases<kLongest, kAll>& biases, const BandPlan& bands,
                                   SatelliteId satellite, GpsTime time, double sigma,
                                   SignalCode first, SignalCode second) {
  const Stored* a = find(biases, satellite, first, time);
  if (a == nullptr) return std::nullopt;
  biases.mark_used(*a, time);
  if (!second.is_set()) return GroupDelay{a->bias_m, sigma};
  const Stored* b = find(biases, satellite, second, time);
  const double f1 = bands.frequency_hz(satellite.system, first.band);
  const double f2 = bands.frequency_hz(satellite.system, second.band);
  if (b != nullptr) biases.mark_used(*b, time);
  if (b == nullptr || !(f1 > 0.0) || !(f2 > 0.0) || f1 == f2) return std::nullopt;
  const IonosphereFree pair = ionosphere_free(f1, f2);
  return GroupDelay{pair.gamma1 * a->bias_m + pair.gamma2 * b->bias_m,
                    combined_sigma(pair, sigma, sigma)};
}

}  // namespace

struct SignalBiasStore::Storage {
  BandPlan bands;
  std::uint64_t arrivals = 0;
  Biases<kMaxIntervals * kMaxSignalBiases, kMaxProductBiases> product;
  Biases<kMaxSignalBiases, kMaxBroadcastBiases> broadcast;
};

SignalBiasStore::SignalBiasStore(const BandPlan& bands) : storage_(std::make_unique<Storage>()) {
  storage_->bands = bands;
}
SignalBiasStore::~SignalBiasStore() = default;
SignalBiasStore::SignalBiasStore(SignalBiasStore&&) noexcept = default;
SignalBiasStore& SignalBiasStore::operator=(SignalBiasStore&&) noexcept = default;

bool is_sane(const SignalBias& bias) {
  const bool has_interval = bias.valid_from.is_set() && bias.valid_until.is_set();
  return is_valid(bias.satellite) && bias.time.nanoseconds() > 0 &&
         is_band_of(bias.satellite.system, bias.code.band) && bias.code.attribute >= 'A' &&
         bias.code.attribute <= 'Z' && std::abs(bias.bias_m) <= kLargestBias_m &&
         (!has_interval || bias.valid_from < bias.valid_until);
}

bool SignalBiasStore::add(const SignalBias& bias) {
  if (!is_sane(bias)) return false;
  switch (bias.kind) {
    case BiasKind::kCode:
      keep(bias, ++storage_->arrivals, &storage_->product);
      break;
    case BiasKind::kBroadcastCode:
      keep(bias, ++storage_->arrivals, &storage_->broadcast);
      break;
    case BiasKind::kPhase:
      break;
  }
  return true;
}

bool SignalBiasStore::has(const SignalBias& bias) const {
  if (!is_valid(bias.satellite) || bias.kind == BiasKind::kPhase) return true;
  return bias.kind == BiasKind::kCode
             ? find(storage_->product, bias.satellite, bias.code, bias.time) != nullptr
             : find(storage_->broadcast, bias.satellite, bias.code, bias.time) != nullptr;
}

std::size_t SignalBiasStore::count_in_system(const SignalBias& bias) const {
  SignalBias other = bias;
  std::size_t count = 0;
  const std::uint16_t highest = kHighestNumber[index_of(bias.satellite.system)];
  for (std::uint16_t number = 1; number <= highest; ++number) {
    other.satellite.number = number;
    count += has(other);
  }
  return count;
}

std::optional<GroupDelay> SignalBiasStore::code_delay(SatelliteId satellite, GpsTime time,
                                                      SignalCode first, SignalCode second) const {
  if (!is_valid(satellite)) return std::nullopt;
  return delay_of(storage_->product, storage_->bands, satellite, time, kBiasSigma, first, second);
}

std::optional<GroupDelay> SignalBiasStore::broadcast_delay(SatelliteId satellite, GpsTime time,
                                                           SignalCode first,
                                                           SignalCode second) const {
  if (!is_valid(satellite)) return std::nullopt;
  return delay_of(storage_->broadcast, storage_->bands, satellite, time, kBroadcastSigma, first,
                  second);
}

}  // namespace leonav
