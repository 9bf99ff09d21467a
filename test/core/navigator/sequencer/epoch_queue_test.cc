// The queue of raw epochs and their stamps by themselves: order, known times, the held epoch, a
// new time.
#include "core/navigator/sequencer/internal/epoch_queue.h"

#include "core/navigator/sequencer/internal/empty_epoch_schedule.h"
#include "core/navigator/sequencer/internal/epoch_stamps.h"
#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

TEST_CASE("epochs wait in order of time, whatever the order they came in") {
  EpochQueue queue;
  for (const double s : {3.0, 1.0, 2.0}) CHECK(queue.insert(epoch_at(at_s(s))) == 0);
  CHECK(queue.newest_time() == at_s(3.0));
  for (const double s : {1.0, 2.0, 3.0}) {
    CHECK(queue.oldest().time == at_s(s));
    queue.remove_oldest();
  }
  CHECK(queue.empty());
}

TEST_CASE("an epoch is a duplicate of one waiting or issued, but not of an empty one") {
  EpochQueue queue;
  queue.insert(epoch_at(at_s(2.0)));
  CHECK(queue.is_known(at_s(2.0)));
  queue.remove_oldest();
  queue.set_issued(at_s(2.0), false);
  CHECK(queue.is_known(at_s(2.0)));
  queue.set_issued(at_s(3.0), true);
  CHECK_FALSE(queue.is_known(at_s(3.0)));
  CHECK(queue.is_late(at_s(3.0)));
  CHECK(queue.last_raw_time() == at_s(2.0));
}

TEST_CASE("a wild stamp is rejected, a run of them is a new time") {
  EpochStamps stamps(1.0);
  for (int i = 1; i < EpochStamps::kRunToRestart; ++i) {
    CHECK(stamps.evaluate(at_s(100.0 + i), GpsTime(), at_s(0.0)).fault == InputFault::kTooFarAhead);
  }
  const StampDecision last = stamps.evaluate(at_s(110.0), GpsTime(), at_s(0.0));
  CHECK(last.fault == InputFault::kNone);
  CHECK(last.starts_new_time);
  CHECK(last.jump_s == 110.0);
}

TEST_CASE("a held epoch is released once") {
  EpochQueue queue;
  EpochStamps stamps(1.0);
  CHECK_FALSE(stamps.leaps(at_s(100.0), GpsTime()));
  CHECK_FALSE(stamps.leaps(at_s(10.0), at_s(0.0)));
  CHECK(stamps.leaps(at_s(10.1), at_s(0.0)));
  queue.hold(epoch_at(at_s(10.1)));
  REQUIRE(queue.has_held());
  CHECK(queue.release_held().time == at_s(10.1));
  CHECK_FALSE(queue.has_held());
}

TEST_CASE("an empty epoch is due after the interval and the wait, which latencies make longer") {
  RealtimeConfig config;
  config.epoch_interval_s = 1.0;
  config.gnss_latency_allowance_s = 0.2;  // at least half an interval counts
  EmptyEpochSchedule schedule(config);
  const auto due = [&](double imu_s) {
    return schedule.due_time(at_s(imu_s), at_s(0.0), at_s(imu_s - 0.005));
  };
  CHECK_FALSE(due(1.499).is_set());
  CHECK(due(1.5) == at_s(1.0));
  CHECK(due(3.5) == at_s(3.495));  // a hole: at its end
  schedule.lengthen_wait(800 * kMs);
  CHECK_FALSE(due(1.999).is_set());
  CHECK(due(2.0) == at_s(1.0));
}

}  // namespace
}  // namespace leonav::test
