// The ProductStore holds the newest broadcast products that were received, for the next start.
#pragma once
#include <mutex>
#include <optional>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// The elements of each satellite, by navigation message, and the ionosphere's coefficients.
struct BroadcastProducts {
  std::vector<Ephemeris> ephemerides;  // at most kMostEphemerides
  std::optional<KlobucharModel> ionosphere;
};

// One thread keeps, another takes. All room is there from the start.
class ProductStore {
 public:
  static constexpr std::size_t kMostEphemerides = 1000;

  ProductStore();

  // Never waits: what comes while the other thread copies is left out, as senders repeat it.
  void keep(const Ephemeris& ephemeris);
  void keep(const KlobucharModel& ionosphere);
  // Copies what there is; `products` should have room. False: nothing has come since the last call.
  bool take(BroadcastProducts* products);

 private:
  std::mutex mutex_;
  BroadcastProducts products_;
  bool changed_ = false;
};

}  // namespace leonav
