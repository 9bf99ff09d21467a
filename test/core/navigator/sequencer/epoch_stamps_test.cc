// Which runs of epochs contradict the time of the IMU, and which are stray, late or held back.
#include "core/navigator/sequencer/internal/epoch_stamps.h"

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

// Epochs from so many seconds on, all at one time of the IMU; returns how many come until one
// starts a new time, or 0.
int count_until_new_time(EpochStamps* stamps, double first_s, int count, double interval_s,
                         GpsTime imu_time, GpsTime newest_epoch) {
  for (int i = 0; i < count; ++i) {
    const GpsTime time = at_s(first_s + i * interval_s);
    if (stamps->evaluate(time, imu_time, newest_epoch).starts_new_time) return i + 1;
  }
  return 0;
}

// The same for late epochs, while the IMU goes on by `imu_step_s` from epoch to epoch.
int count_late_until_new_time(EpochStamps* stamps, double first_s, int count, double interval_s,
                              GpsTime imu_time, double imu_step_s, GpsTime last_issued) {
  for (int i = 0; i < count; ++i)
    if (stamps->add_late(at_s(first_s + i * interval_s), imu_time.plus_seconds(i * imu_step_s),
                         last_issued))
      return i + 1;
  return 0;
}

TEST_CASE("five epochs contradict a time that no epoch has confirmed, twelve a confirmed one") {
  EpochStamps stamps(1.0);
  const bool confirmed = GENERATE(false, true);
  if (confirmed) stamps.add_good(true);
  CHECK(stamps.confirms_imu() == confirmed);
  stamps.evaluate(at_s(0.0), at_s(0.0), GpsTime());
  CHECK(count_until_new_time(&stamps, 1000.0, 20, 1.0, at_s(0.0), at_s(0.0)) ==
        (confirmed ? EpochStamps::kRunWithImu : EpochStamps::kRunToRestart));
  // At 10 Hz twelve do not last as long as the IMU may be silent.
  EpochStamps fast(0.1);
  if (confirmed) fast.add_good(true);
  CHECK(count_until_new_time(&fast, 1000.0, 200, 0.1, at_s(0.0), at_s(0.0)) ==
        (confirmed ? 102 : EpochStamps::kRunToRestart));
}

TEST_CASE("a sample of the IMU ends the run that would contradict a confirmed time") {
  EpochStamps stamps(1.0);
  stamps.add_good(true);
  for (int k = 0; k < 10; ++k) {
    CHECK(count_until_new_time(&stamps, 1000.0, EpochStamps::kRunWithImu - 1, 1.0, at_s(k),
                               at_s(0.0)) == 0);
    stamps.add_imu_sample();
  }
}

TEST_CASE("epochs that a stalled link held back do not contradict a confirmed IMU") {
  for (const double interval_s : {1.0, 0.1}) {
    EpochStamps stamps(interval_s);
    stamps.add_good(true);
    const auto at_once = [&](double stall_s) {
      const int epochs = static_cast<int>(stall_s / interval_s) + 1;
      return count_until_new_time(&stamps, 100.0 - stall_s, epochs, interval_s, at_s(100.0),
                                  at_s(100.0 - stall_s));
    };
    CHECK(at_once(25.0) == 0);
    CHECK(at_once(69.0) == 0);  // of these the last ten seconds are no longer too old
  }
  // GNSS whose clock was set back while the IMU fell silent goes on for longer.
  EpochStamps stamps(1.0);
  stamps.add_good(true);
  CHECK(count_until_new_time(&stamps, -3600.0, 100, 1.0, at_s(0.0), at_s(0.0)) == 62);
}

TEST_CASE("epochs older than the newest continue a run only if they are too old to be late") {
  EpochStamps stamps(1.0);
  CHECK(stamps.evaluate(at_s(-60.0), at_s(0.0), at_s(0.0)).fault == InputFault::kTimeBackwards);
  // Five epochs that are 0.9 s late.
  for (double s = 1.0; s < 6.0; s += 1.0)
    CHECK(stamps.evaluate(at_s(s), at_s(s + 0.9), at_s(s + 0.5)).fault == InputFault::kNone);
  // Behind wrong epochs, first by more than ten seconds.
  EpochStamps behind(1.0);
  CHECK(behind.evaluate(at_s(-10.5), GpsTime(), at_s(0.0)).fault == InputFault::kTimeBackwards);
  CHECK(count_until_new_time(&behind, -9.5, 10, 1.0, GpsTime(), at_s(0.0)) ==
        EpochStamps::kRunToRestart - 1);
}

TEST_CASE("IMU and epoch are apart beyond what GNSS may be late and an interval and a half") {
  const EpochStamps stamps(2.0);
  CHECK(stamps.max_imu_offset_ns() == 5'000 * kMs);
  CHECK_FALSE(stamps.are_apart(at_ms(5000), at_ms(0)));
  CHECK_FALSE(stamps.are_apart(at_ms(0), at_ms(5000)));
  CHECK(stamps.are_apart(at_ms(5001), at_ms(0)));
  CHECK(stamps.are_apart(at_ms(0), at_ms(5001)));
}

TEST_CASE("late epochs contradict the IMU where it is too far from them") {
  EpochStamps stamps(1.0);
  // Nothing has confirmed it: five, over more than three seconds.
  CHECK(count_late_until_new_time(&stamps, 0.0, 20, 1.0, at_s(6.0), 1.0, GpsTime()) == 5);
  stamps.add_good(true);
  CHECK(count_late_until_new_time(&stamps, 0.0, 20, 1.0, at_s(6.0), 1.0, GpsTime()) == 12);
  EpochStamps fast(0.1);
  CHECK(count_late_until_new_time(&fast, 0.0, 200, 0.1, at_s(6.0), 0.1, GpsTime()) == 32);
  fast.add_good(true);
  CHECK(count_late_until_new_time(&fast, 0.0, 200, 0.1, at_s(6.0), 0.1, GpsTime()) == 102);
}

TEST_CASE("late epochs that fit the IMU contradict epochs issued before, but no empty ones") {
  EpochStamps stamps(1.0);
  stamps.add_good(true);
  const auto late = [&](GpsTime last_issued) {
    int count = 0;
    for (double s = 1.0; s < 10.0; s += 1.0) {
      ++count;
      if (stamps.add_late(at_s(s), at_s(s), last_issued)) return count;
    }
    return 0;
  };
  CHECK(late(at_s(20.0)) == 5);
  CHECK(late(at_s(0.0)) == 0);  // GNSS is slow: only empty epochs are later
}

TEST_CASE("a backlog that is sent faster than it was measured contradicts nothing") {
  const double stall_s = GENERATE(12.0, 60.0, 600.0);
  for (const double interval_s : {0.05, 0.1, 1.0, 2.0}) {
    for (const double times_faster : {1.3, 1.5, 2.0, 3.0, 5.0}) {
      CAPTURE(stall_s, interval_s, times_faster);
      EpochStamps stamps(interval_s);
      stamps.add_good(true);
      bool starts_new_time = false;
      // The stall begins at 0 s.
      for (int k = 1; k < 100'000; ++k) {
        const double epoch_s = k * interval_s, now_s = stall_s + epoch_s / times_faster;
        if (epoch_s > now_s) break;
        const StampDecision stamp = stamps.evaluate(at_s(epoch_s), at_s(now_s), at_s(now_s - 1.0));
        starts_new_time = starts_new_time || stamp.starts_new_time;
        if (stamp.fault == InputFault::kNone)
          starts_new_time =
              starts_new_time || stamps.add_late(at_s(epoch_s), at_s(now_s), at_s(0.0));
        stamps.add_imu_sample();
      }
      CHECK_FALSE(starts_new_time);
    }
  }
}

TEST_CASE("late epochs of two kinds make no run together") {
  EpochStamps stamps(0.1);  // epochs that are more than 2.15 s late do not fit the IMU
  stamps.add_good(true);
  const bool is_slow = GENERATE(false, true);
  for (int k = 0; k < 200; ++k) {
    const double s = 0.1 * k;
    // They fit, behind an epoch issued before. One in eight is far from the IMU, or only slow.
    const bool is_other = k % 8 == 7;
    const GpsTime last_issued = is_other && is_slow ? at_s(-1.0) : at_s(100.0);
    CHECK_FALSE(
        stamps.add_late(at_s(s), at_s(s + (is_other && !is_slow ? 3.0 : 1.0)), last_issued));
  }
}

TEST_CASE("latency that goes to and fro about the limit contradicts nothing") {
  EpochStamps stamps(0.1);  // the limit is 2.15 s
  stamps.add_good(true);
  for (int k = 0; k < 1000; ++k) {
    const double s = 0.1 * k, latency_s = k % 2 == 0 ? 2.1 : 2.3;
    REQUIRE_FALSE(stamps.add_late(at_s(s), at_s(s + latency_s), at_s(-1.0)));
  }
}

TEST_CASE("old epochs that are sent again do not contradict a confirmed IMU") {
  // All at once, when the IMU is at 20 s: the first ones are far from it, the last ones fit.
  for (const double interval_s : {0.05, 0.1, 0.5, 1.0, 2.0, 5.0, 30.0}) {
    CAPTURE(interval_s);
    EpochStamps stamps(interval_s);
    stamps.add_good(true);
    const int epochs = static_cast<int>(9.9 / interval_s);
    CHECK(count_late_until_new_time(&stamps, 20.0 - epochs * interval_s, epochs, interval_s,
                                    at_s(20.0), 0.0, at_s(20.0)) == 0);
  }
}

}  // namespace
}  // namespace leonav::test
