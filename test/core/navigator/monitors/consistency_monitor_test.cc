#include "core/navigator/monitors/consistency_monitor.h"

#include <cmath>

#include "support/catch.h"

using namespace leonav;

namespace {

// Epochs until the watch calls out; -1: never within `epochs`.
int epochs_to_alarm(ConsistencyMonitor* watch, double ratio, int epochs) {
  for (int i = 1; i <= epochs; ++i)
    if (watch->add(ratio)) return i;
  return -1;
}

}  // namespace

TEST_CASE("lasting improbability is called out once, chance and single leaps are not") {
  ConsistencyMonitor watch;
  for (int i = 0; i < 1000; ++i) CHECK_FALSE(watch.add(i % 2 == 0 ? 0.4 : 1.6));
  CHECK_FALSE(watch.add(1e9));
  CHECK_FALSE(watch.add(std::nan("")));
  CHECK(epochs_to_alarm(&watch, 1.0, 100) == -1);
  // 1 + 2 (1 - (29/30)^n) > 2 from n = 21 on.
  CHECK(epochs_to_alarm(&watch, 3.0, 100) == 21);
  CHECK(watch.mean() > 2.0);
  CHECK(epochs_to_alarm(&watch, 3.0, 1000) == -1);
  CHECK(epochs_to_alarm(&watch, 1.0, 200) == -1);  // recovers
  CHECK(epochs_to_alarm(&watch, 3.0, 100) > 0);
}
