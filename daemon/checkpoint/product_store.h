// The ProductStore holds the newest broadcast products that were received, for the next start.
#pragma once
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"

namespace leonav {

// The elements of each satellite, by navigation message, the biases of its signals' codes, and the
// ionosphere's coefficients.
struct BroadcastProducts {
  std::vector<Ephemeris> ephemerides;  // at most kMostEphemerides
  std::vector<SignalBias> biases;      // at most kMostBiases, by the time when they were received
  std::optional<KlobucharModel> ionosphere;
};

// Returns the first of `biases` that fit into one message: received at the same time, at most
// kMaxBiases.
std::span<const SignalBias> first_message_of(std::span<const SignalBias> biases);

// One thread keeps, another takes. All room is there from the start.
class ProductStore {
 public:
  static constexpr std::size_t kMostEphemerides = 1000;
  static constexpr std::size_t kMostBiases = 4096;

  ProductStore();

  // Never waits: what comes while the other thread copies is left out, as senders repeat it.
  void keep(const Ephemeris& ephemeris);
  void keep(const KlobucharModel& ionosphere);
  // Of a signal as many as SignalBiasStore keeps: those in force and those that begin next, at the
  // time when the last one was received; of several in force the newest. Where there is no room for
  // all signals, ended biases make some; those that hold or will hold stay, and the new ones are
  // left out. Biases of carriers, which nothing uses, are left out too.
  void keep(std::span<const SignalBias> biases);
  // Copies what there is; `products` should have room. False: nothing has come since the last call.
  bool take(BroadcastProducts* products);

 private:
  void keep_bias(const SignalBias& bias);

  std::mutex mutex_;
  BroadcastProducts products_;  // its biases by satellite, kind, signal and beginning
  bool changed_ = false;
};

}  // namespace leonav
