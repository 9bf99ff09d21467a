// How long HEALTH keeps a convention that was broken.
#include "daemon/health/internal/convention_monitor.h"

#include <string>

#include "support/catch.h"

namespace {

using namespace leonav;

void tell(EngineCounters* counters, Convention convention, double value, bool comes_again = true) {
  const auto i = static_cast<std::size_t>(convention);
  counters->conventions[i].set(counters->conventions[i].get() + 1);
  if (comes_again) counters->lasting_conventions[i].set(counters->lasting_conventions[i].get() + 1);
  counters->convention_milli[i].set(static_cast<std::int64_t>(1e3 * value));
}

}  // namespace

TEST_CASE("stamps that have come right are forgotten after two minutes, axes never") {
  EngineCounters counters;
  ConventionMonitor monitor(&counters);
  CHECK(monitor.look(0.0).empty());
  tell(&counters, Convention::kLeapSeconds, 18.0);
  CHECK(monitor.look(1.0).size() == 1);
  const std::string told = monitor.suspicions();
  CHECK(told.find("18") != std::string::npos);
  // Found again with a slightly other value: the same text.
  tell(&counters, Convention::kLeapSeconds, 17.98);
  CHECK(monitor.look(61.0).size() == 1);
  CHECK(monitor.suspicions() == told);
  CHECK(monitor.look(181.0).size() == 1);
  CHECK(monitor.look(182.0).empty());
  // What is told but once, stamps as well, stays.
  for (const Convention once : {Convention::kMirrored, Convention::kLeapSeconds}) {
    EngineCounters others;
    ConventionMonitor watch(&others);
    tell(&others, once, 18.0, false);
    CHECK(watch.look(183.0).size() == 1);
    CHECK(watch.look(100'000.0).size() == 1);
  }
}
