#include "daemon/checkpoint/product_store.h"

#include <algorithm>
#include <utility>

namespace leonav {

ProductStore::ProductStore() { products_.ephemerides.reserve(kMostEphemerides); }

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

bool ProductStore::take(BroadcastProducts* products) {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(changed_, false)) return false;
  *products = products_;
  return true;
}

}  // namespace leonav
