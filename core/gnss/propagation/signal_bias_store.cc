#include "core/gnss/propagation/signal_bias_store.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/base/capacity.h"

namespace leonav {
namespace {

// 1 sigma of the bias of one signal: estimated biases agree between analysis centres to 0.1 to 0.3
// ns (IGS multi-GNSS experiment).
constexpr double kBiasSigma = 0.06;  // m

struct Stored {
  SignalCode code;
  GpsTime time;
  double bias_m = 0.0;
  std::uint64_t arrival = 0;
};

using SatelliteBiases = boost::container::static_vector<Stored, kMaxSignalBiases>;

const Stored* find(const SatelliteBiases& biases, SignalCode code, GpsTime time) {
  for (const Stored& stored : biases) {
    if (stored.code != code) continue;
    return std::abs(seconds_between(time, stored.time)) <= kLongestBiasAge_s ? &stored : nullptr;
  }
  return nullptr;
}

}  // namespace

struct SignalBiasStore::Storage {
  BandPlan bands;
  std::uint64_t arrivals = 0;
  std::array<SatelliteBiases, kMaxEphemerisSatellites> of;
};

SignalBiasStore::SignalBiasStore(const BandPlan& bands) : storage_(std::make_unique<Storage>()) {
  storage_->bands = bands;
}
SignalBiasStore::~SignalBiasStore() = default;
SignalBiasStore::SignalBiasStore(SignalBiasStore&&) noexcept = default;
SignalBiasStore& SignalBiasStore::operator=(SignalBiasStore&&) noexcept = default;

bool is_sane(const SignalBias& bias) {
  return is_valid(bias.satellite) && bias.time.nanoseconds() > 0 &&
         is_band_of(bias.satellite.system, bias.code.band) && bias.code.attribute >= 'A' &&
         bias.code.attribute <= 'Z' && std::abs(bias.bias_m) <= kLargestBias_m;
}

bool SignalBiasStore::add(const SignalBias& bias) {
  if (!is_sane(bias)) return false;
  if (bias.kind != BiasKind::kCode) return true;
  SatelliteBiases& biases = storage_->of[table_index_of(bias.satellite)];
  auto slot = std::find_if(biases.begin(), biases.end(),
                           [&](const Stored& stored) { return stored.code == bias.code; });
  if (slot == biases.end() && biases.size() < biases.capacity()) {
    biases.emplace_back();
    slot = biases.end() - 1;
  }
  if (slot == biases.end()) {
    slot = std::min_element(biases.begin(), biases.end(),
                            [](const Stored& a, const Stored& b) { return a.arrival < b.arrival; });
  }
  *slot = {bias.code, bias.time, bias.bias_m, ++storage_->arrivals};
  return true;
}

std::optional<GroupDelay> SignalBiasStore::code_delay(SatelliteId satellite, GpsTime time,
                                                      SignalCode first, SignalCode second) const {
  if (!is_valid(satellite)) return std::nullopt;
  const SatelliteBiases& biases = storage_->of[table_index_of(satellite)];
  const Stored* a = find(biases, first, time);
  if (a == nullptr) return std::nullopt;
  if (!second.is_set()) return GroupDelay{a->bias_m, kBiasSigma};
  const Stored* b = find(biases, second, time);
  const double f1 = storage_->bands.frequency_hz(satellite.system, first.band);
  const double f2 = storage_->bands.frequency_hz(satellite.system, second.band);
  if (b == nullptr || !(f1 > 0.0) || !(f2 > 0.0) || f1 == f2) return std::nullopt;
  const double gamma1 = f1 * f1 / (f1 * f1 - f2 * f2), gamma2 = 1.0 - gamma1;
  return GroupDelay{gamma1 * a->bias_m + gamma2 * b->bias_m,
                    kBiasSigma * std::hypot(gamma1, gamma2)};
}

}  // namespace leonav
