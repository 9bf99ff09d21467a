// Which fault is told of an input that is rejected for several.
#include "daemon/health/internal/recent_faults.h"

#include "support/catch.h"

namespace {

using namespace leonav;

struct FaultRig {
  void refuse(InputFault fault, std::int64_t count) {
    Gauge& gauge =
        counters.refused_by[index_of(Channel::kEphemeris)][static_cast<std::size_t>(fault)];
    gauge.set(gauge.get() + count);
  }
  InputFault look() {
    faults.look(counters);
    return faults.most_frequent(Channel::kEphemeris);
  }
  EngineCounters counters;
  RecentFaults faults;
};

}  // namespace

TEST_CASE("two faults in turn are one that is told, until one of them has twice as many") {
  FaultRig rig;
  CHECK(rig.look() == InputFault::kNone);
  rig.refuse(InputFault::kUndecodable, 5);
  for (int i = 0; i < 50; ++i) {
    rig.refuse(InputFault::kUndecodable, 5 + i % 2);
    rig.refuse(InputFault::kUnknownSchema, 6 - i % 2);
    CHECK(rig.look() == InputFault::kUndecodable);
  }
  for (int i = 0; i < 10; ++i) {
    rig.refuse(InputFault::kUnknownSchema, 20);
    rig.look();
  }
  CHECK(rig.look() == InputFault::kUnknownSchema);
  for (int i = 0; i < 10; ++i) rig.look();
  CHECK(rig.look() == InputFault::kNone);
}
