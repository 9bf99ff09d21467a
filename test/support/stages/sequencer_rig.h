// A Sequencer whose work is recorded, with simple inputs for it.
#pragma once
#include <cstdint>

#include "support/catch.h"
#include "support/stages/recording_stages.h"
#include "support/stages/simple_sample.h"

namespace leonav::test {

inline const GpsTime kStart = GpsTime::from_week_and_tow(2200, 100'000.0);
inline constexpr std::int64_t kMs = 1'000'000;

inline GpsTime at_s(double s) { return kStart.plus_seconds(s); }
inline GpsTime at_ms(std::int64_t ms) { return kStart.plus_nanoseconds(ms * kMs); }

inline RawEpoch epoch_at(GpsTime time) {
  RawEpoch raw;
  raw.time = time;
  SignalObservation observation;
  observation.satellite = {System::kGps, 5};
  observation.code = {'1', 'C'};
  observation.pseudorange_m = 2.2e7;
  raw.observations.push_back(observation);
  return raw;
}

struct SequencerRig {
  NavigatorConfig config;
  RecordingStages stages;
  Sequencer sequencer;
  SequencerRig() : SequencerRig(NavigatorConfig()) {}
  explicit SequencerRig(const NavigatorConfig& c) : config(c), sequencer(c, &stages) {}
  // IMU at 200 Hz over (from, to] milliseconds.
  void imu(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms + 5; ms <= to_ms; ms += 5) {
      sequencer.on_imu(sample_until(at_ms(ms)));
    }
  }
  std::uint64_t rejected(InputFault fault) const {
    return sequencer.counters().rejected[static_cast<std::size_t>(fault)];
  }
  std::uint64_t rejected() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : sequencer.counters().rejected) sum += count;
    return sum;
  }
};

// Blocks must tile the IMU stream: contiguous, cut exactly at the epochs, nothing lost.
inline void check_tiling(const RecordingStages& stages) {
  GpsTime end = stages.samples.front().start();
  Eigen::Vector3d theta = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  for (const auto& block : stages.blocks) {
    for (const ImuSample& sample : block.samples) {
      REQUIRE(sample.start() == end);
      REQUIRE(sample.interval_ns > 0);
      end = sample.time;
      theta += sample.delta_theta_b;
      velocity += sample.delta_velocity_b;
    }
    REQUIRE(end == block.time);
  }
  Eigen::Vector3d theta_in = Eigen::Vector3d::Zero(), velocity_in = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : stages.samples) {
    if (sample.start() >= end) break;
    const double share =
        sample.time <= end ? 1.0 : seconds_between(end, sample.start()) / sample.interval_s();
    theta_in += share * sample.delta_theta_b;
    velocity_in += share * sample.delta_velocity_b;
  }
  CHECK((theta - theta_in).norm() < 1e-12 * (1.0 + theta_in.norm()));
  CHECK((velocity - velocity_in).norm() < 1e-12 * (1.0 + velocity_in.norm()));
}

}  // namespace leonav::test
