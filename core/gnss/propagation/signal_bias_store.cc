#include "core/gnss/propagation/signal_bias_store.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/capacity.h"
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
};

template <std::size_t capacity>
using Biases = boost::container::static_vector<Stored, capacity>;

bool has_ended(const Stored& stored, GpsTime time) {
  return stored.valid_until.is_set() && time >= stored.valid_until;
}

bool holds(const Stored& stored, GpsTime time) {
  if (stored.valid_from.is_set() && time < stored.valid_from) return false;
  if (stored.valid_until.is_set()) return !has_ended(stored, time);
  return std::abs(seconds_between(time, stored.time)) <= kLongestBiasAge_s;
}

template <std::size_t capacity>
const Stored* find(const Biases<capacity>& biases, SignalCode code, GpsTime time) {
  const Stored* newest = nullptr;
  for (const Stored& stored : biases) {
    if (stored.code != code || !holds(stored, time)) continue;
    if (newest == nullptr || stored.arrival > newest->arrival) newest = &stored;
  }
  return newest;
}

template <std::size_t capacity>
void keep(const SignalBias& bias, std::uint64_t arrival, Biases<capacity>* biases) {
  auto slot = std::find_if(biases->begin(), biases->end(), [&](const Stored& stored) {
    return stored.code == bias.code && stored.valid_from == bias.valid_from;
  });
  if (slot == biases->end() && biases->size() < biases->capacity()) {
    biases->emplace_back();
    slot = biases->end() - 1;
  }
  if (slot == biases->end()) {
    slot = std::min_element(biases->begin(), biases->end(), [&](const Stored& a, const Stored& b) {
      const bool a_ended = has_ended(a, bias.time), b_ended = has_ended(b, bias.time);
      return a_ended != b_ended ? a_ended : a.arrival < b.arrival;
    });
  }
  *slot = {bias.code, bias.time, bias.valid_from, bias.valid_until, bias.bias_m, arrival};
}

template <std::size_t capacity>
std::optional<GroupDelay> delay_of(const Biases<capacity>& biases, const BandPlan& bands,
                                   System system, GpsTime time, double sigma, SignalCode first,
                                   SignalCode second) {
  const Stored* a = find(biases, first, time);
  if (a == nullptr) return std::nullopt;
  if (!second.is_set()) return GroupDelay{a->bias_m, sigma};
  const Stored* b = find(biases, second, time);
  const double f1 = bands.frequency_hz(system, first.band);
  const double f2 = bands.frequency_hz(system, second.band);
  if (b == nullptr || !(f1 > 0.0) || !(f2 > 0.0) || f1 == f2) return std::nullopt;
  const IonosphereFree pair = ionosphere_free(f1, f2);
  return GroupDelay{pair.gamma1 * a->bias_m + pair.gamma2 * b->bias_m,
                    combined_sigma(pair, sigma, sigma)};
}

}  // namespace

struct SignalBiasStore::Storage {
  struct Satellite {
    Biases<kMaxIntervals * kMaxSignalBiases> product;
    Biases<kMaxSignalBiases> broadcast;
  };
  BandPlan bands;
  std::uint64_t arrivals = 0;
  std::array<Satellite, kMaxEphemerisSatellites> of;
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
  Storage::Satellite& satellite = storage_->of[table_index_of(bias.satellite)];
  switch (bias.kind) {
    case BiasKind::kCode:
      keep(bias, ++storage_->arrivals, &satellite.product);
      break;
    case BiasKind::kBroadcastCode:
      keep(bias, ++storage_->arrivals, &satellite.broadcast);
      break;
    case BiasKind::kPhase:
      break;
  }
  return true;
}

bool SignalBiasStore::has(const SignalBias& bias) const {
  if (!is_valid(bias.satellite) || bias.kind == BiasKind::kPhase) return true;
  const Storage::Satellite& satellite = storage_->of[table_index_of(bias.satellite)];
  return bias.kind == BiasKind::kCode ? find(satellite.product, bias.code, bias.time) != nullptr
                                      : find(satellite.broadcast, bias.code, bias.time) != nullptr;
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
  return delay_of(storage_->of[table_index_of(satellite)].product, storage_->bands,
                  satellite.system, time, kBiasSigma, first, second);
}

std::optional<GroupDelay> SignalBiasStore::broadcast_delay(SatelliteId satellite, GpsTime time,
                                                           SignalCode first,
                                                           SignalCode second) const {
  if (!is_valid(satellite)) return std::nullopt;
  return delay_of(storage_->of[table_index_of(satellite)].broadcast, storage_->bands,
                  satellite.system, time, kBroadcastSigma, first, second);
}

}  // namespace leonav
