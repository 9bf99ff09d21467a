#include "test/fuzz/good_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"
#include "test/fuzz/fuzz_target.h"

namespace leonav::test {
namespace {

constexpr std::int64_t kDay = 86'400 * kSecond;

// How long the Sequencer may need, from its rules: an accepted epoch lies so far ahead of the IMU's
// stamps, to which the configured offset is added. Then one epoch may be late, by which the wait
// for the others becomes long enough, and two come.
int recovery_seconds(const NavigatorConfig& config) {
  const double ahead_s = std::max(10.0, 3.0 * config.realtime.epoch_interval_s);
  return static_cast<int>(std::ceil(ahead_s + std::max(config.imu_time_offset_s, 0.0))) + 3;
}

}  // namespace

void CheckedStages::open_epoch(std::uint64_t index) {
  expect(index == last_index_ + 1, "an epoch is opened out of turn");
  opened_ = index;
}

void CheckedStages::push_inertial(const InertialWork& work) {
  if (std::holds_alternative<Restart>(work)) {
    if (std::get<Restart>(work).cause == ResetCause::kTimeBase) last_sample_ = GpsTime();
  } else if (const auto* issued = std::get_if<EpochIssued>(&work)) {
    expect(issued->index == opened_, "an epoch is issued that was not opened");
  } else if (const auto* data = std::get_if<TimeWithoutImu>(&work)) {
    expect(data->time.is_set(), "data without a time");
  } else {
    const auto& sample = std::get<ImuSample>(work);
    expect(sample.interval_ns > 0, "a sample's interval is not positive");
    expect(sample.delta_theta_b.allFinite() && sample.delta_velocity_b.allFinite(),
           "a sample is not finite");
    expect(!last_sample_.is_set() || sample.start() >= last_sample_, "samples overlap");
    last_sample_ = sample.time;
  }
}

void CheckedStages::push_gnss(const GnssWork& work) {
  if (const auto* epoch = std::get_if<EpochWork>(&work)) check_epoch(*epoch);
  const auto* command = std::get_if<Command>(&work);
  if (command == nullptr) return;
  expect(check(*command) == InputFault::kNone, "a command that is refused");
  if (command->kind == CommandKind::kRestart && command->cause == ResetCause::kTimeBase)
    last_epoch_ = GpsTime();
}

void CheckedStages::check_epoch(const EpochWork& work) {
  expect(work.index == last_index_ + 1, "an epoch's index does not follow");
  last_index_ = work.index;
  expect(is_plausible(work.time), "an epoch at an impossible time");
  expect(!last_epoch_.is_set() || work.time > last_epoch_, "epochs do not increase");
  expect(work.raw.time == work.time, "an epoch with two times");
  expect(!work.empty || work.raw.observations.empty(), "an empty epoch with observations");
  GpsTime end = last_epoch_;
  for (const ImuSample& sample : work.block) {
    expect(sample.interval_ns > 0, "a block's interval is not positive");
    expect(!end.is_set() || sample.start() >= end, "blocks overlap");
    end = sample.time;
  }
  expect(work.block.empty() || end <= work.time, "a block ends behind its epoch");
  for (const OdometerIncrement& one : work.odometer) {
    expect(one.time <= work.time, "an odometer increment ends behind its epoch");
  }
  for (std::size_t i = 1; i < work.raw.observations.size(); ++i) {
    expect(comes_before(work.raw.observations[i - 1], work.raw.observations[i]),
           "observations are not sorted");
  }
  last_epoch_ = work.time;
  if (work.empty || work.raw.observations.empty()) return;
  // A block that reaches up to the epoch: its samples have come.
  before_newest_ = std::exchange(newest_, {work.time, !work.block.empty() && end == work.time});
}

void CheckedStages::event(const Event& event) {
  expect(event.sequence > last_event_, "events' numbers do not increase");
  last_event_ = event.sequence;
}

GoodInput hidden_good_input(GpsTime now, std::uint64_t hash, bool is_whole) {
  constexpr std::array<std::int64_t, 10> kMoves = {
      kSecond, 0,         7 * kSecond,   -7 * kSecond, 3'600 * kSecond,
      -kDay,   21 * kDay, -3'000 * kDay, 5 * kDay,     3'000 * kDay};
  const auto fraction = static_cast<std::int64_t>(hash / kMoves.size() % 1000) * kMs;
  const GpsTime base = now.plus_nanoseconds(kMoves[hash % kMoves.size()] + fraction);
  return {base, is_whole ? 5 * kMs : 20 * kMs, !is_whole};
}

void require_recovery(const NavigatorConfig& config, Sequencer* sequencer, CheckedStages* stages,
                      const GoodInput& good) {
  const int seconds = recovery_seconds(config);
  const bool inertial = config.motion == MotionModel::kInertial;
  const auto feed_samples = [&](GpsTime begin, std::int64_t duration_ns) {
    for (std::int64_t ns = good.sample_interval_ns; ns <= duration_ns;
         ns += good.sample_interval_ns)
      sequencer->on_imu(sample_until(begin.plus_nanoseconds(ns), good.sample_interval_ns));
  };
  // The epochs of the good input alone are at whole seconds from its base.
  const auto is_good = [&](const CheckedStages::Epoch& epoch, int second) {
    return epoch.time == good.base.plus_nanoseconds(second * kSecond) &&
           (epoch.has_samples || !inertial);
  };
  const auto have_come = [&](int second) {
    return is_good(stages->before_newest(), second - 1) && is_good(stages->newest(), second);
  };
  int last_pair = 0;  // the second of the newest epoch that has come with the one before it
  std::uint64_t late_before = 0;  // without the last three
  for (int second = 1; second <= seconds; ++second) {
    const GpsTime begin = good.base.plus_nanoseconds((second - 1) * kSecond);
    if (second == seconds - 2) late_before = sequencer->counters().late_epochs;
    feed_samples(begin, kSecond);
    sequencer->on_raw_epoch(epoch_of(begin.plus_nanoseconds(kSecond), 5));
    last_pair = have_come(second) ? second : have_come(second - 1) ? second - 1 : last_pair;
    if (good.stops_early && last_pair > 0) return;
  }
  // The IMU passes the last epoch even where its stamps are taken to be later or to jitter.
  feed_samples(good.base.plus_nanoseconds(seconds * kSecond), kSecond / 2);
  if (have_come(seconds)) return;
  // One of the last three may be late, not more: the latency that a configured offset makes is as
  // long as the longest allowance, and stamps that have jittered are laid a little off.
  if (sequencer->counters().late_epochs == late_before + 1 && last_pair >= seconds - 2) return;
  throw Finding("a dead end: after " + std::to_string(seconds) +
                " s of good input the last two epochs have not reached the stages");
}

RawEpoch epoch_of(GpsTime time, std::size_t satellites) {
  RawEpoch raw;
  raw.time = time;
  for (std::size_t i = 0; i < std::min(satellites, raw.observations.capacity()); ++i) {
    SignalObservation observation;
    const auto system = i < 63 ? System::kGps : i < 113 ? System::kGalileo : System::kLeo;
    const std::size_t first = i < 63 ? 0 : i < 113 ? 63 : 113;
    observation.satellite = {system, static_cast<std::uint16_t>(i - first + 1)};
    observation.code = {'1', 'C'};
    observation.pseudorange_m = 2.2e7 + 1000.0 * static_cast<double>(i);
    raw.observations.push_back(observation);
  }
  return raw;
}

}  // namespace leonav::test
