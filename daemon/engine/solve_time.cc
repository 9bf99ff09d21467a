#include "daemon/engine/solve_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

#include "core/earth/ellipsoid.h"
#include "core/navigator/stages/smoother_stage.h"
#include "daemon/config/load_config.h"
#include "daemon/threads/thread_time.h"

namespace leonav {
namespace {

using namespace ekf_index;

constexpr double kImuInterval_s = 0.005;
constexpr double kOrbit_m = 2.66e7;
constexpr double kGravity_m_s2 = 9.78;  // at the equator
// Satellites in view under an open sky.
constexpr std::array<int, kSystemCount> kInView = {11, 9, 15, 10};
constexpr GpsTime kStart = GpsTime::from_nanoseconds(2000 * kNanosecondsPerWeek);

int satellites_of(const GnssConfig& config) {
  int sum = 0;
  for (const System system : kSystems) {
    const SystemConfig& one = config.systems[index_of(system)];
    if (!one.enabled) continue;
    const int in_view = kInView[index_of(system)];
    sum += one.max_satellites > 0 ? std::min(one.max_satellites, in_view) : in_view;
  }
  return std::clamp(sum, 4, static_cast<int>(kMaxArcs));
}

// Drops all outputs, and counts the solves with a result.
class CountingSink final : public OutputSink {
 public:
  int solved = 0;

 private:
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport&) override {}
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport& report) override {
    solved += report.status == SmootherStatus::kOk ? 1 : 0;
  }
};

class OneIteration final : public SolveBudget {
  bool may_iterate(int) override { return false; }
};

double keyframe_interval_s(const NavigatorConfig& config) {
  return std::max(config.smoother.keyframe_interval_s, config.realtime.epoch_interval_s);
}

// Keyframes of a vehicle that stands at zero latitude and longitude, its axes those of ECEF.
class StandingVehicle {
 public:
  StandingVehicle(const NavigatorConfig& config, int satellites)
      : interval_s_(keyframe_interval_s(config)) {
    keyframe_.valid = true;
    keyframe_.follows_previous = true;
    keyframe_.has_attitude = config.motion == MotionModel::kInertial;
    keyframe_.has_gnss = true;
    keyframe_.block_complete = true;
    FilterState& state = keyframe_.state;
    state.nav.p_e = {kEarthSemiMajorAxis, 0.0, 0.0};
    keyframe_.measured_rate_b = {0.0, 0.0, kEarthRotationRate};
    antenna_e_ = state.nav.p_e + config.vehicle.lever_arm_b;
    for (int i = 0; i < satellites; ++i) add_satellite(i, satellites);
    const Eigen::Index size = state.size() + satellites;
    keyframe_.covariance = EkfCovariance::Identity(size, size) * 1e-4;
    keyframe_.process.begin(size);
    keyframe_.process.noise.topLeftCorner(kSize, kSize) =
        EkfCovariance::Identity(kSize, kSize) * 1e-8;
    if (keyframe_.has_attitude) return;
    // Attitude and errors of the IMU are no states.
    for (int i = kAttitude; i < kInsSize; ++i)
      keyframe_.covariance(i, i) = keyframe_.process.noise(i, i) = 0.0;
  }

  const KeyframeInput& next() {
    ++keyframe_.index;
    keyframe_.from = keyframe_.state;
    const GpsTime before = keyframe_.time.is_set() ? keyframe_.time : kStart;
    keyframe_.time = before.plus_seconds(interval_s_);
    keyframe_.state.nav.time = keyframe_.time;
    keyframe_.prior = keyframe_.state;
    keyframe_.block.clear();
    const double samples = std::min(interval_s_ / kImuInterval_s, double{kMaxImuBlock});
    for (int i = 1; i <= static_cast<int>(samples); ++i) {
      keyframe_.block.push_back(sample(before.plus_seconds(i * kImuInterval_s)));
    }
    keyframe_.sample_before_block = sample(before);
    return keyframe_;
  }

 private:
  static ImuSample sample(GpsTime time) {
    ImuSample sample;
    sample.time = time;
    sample.interval_ns = std::llround(kImuInterval_s * 1e9);
    sample.delta_theta_b = {0.0, 0.0, kEarthRotationRate * kImuInterval_s};
    sample.delta_velocity_b = {kGravity_m_s2 * kImuInterval_s, 0.0, 0.0};
    return sample;
  }

  // In a spiral from the zenith (+x) down to ten degrees.
  void add_satellite(int i, int satellites) {
    const double elevation = std::asin(1.0 - 0.83 * (i + 0.5) / satellites);
    const double azimuth = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Eigen::Vector3d direction = {std::sin(elevation), std::cos(elevation) * std::sin(azimuth),
                                       std::cos(elevation) * std::cos(azimuth)};
    SatelliteInView satellite;
    satellite.satellite = {kSystems[static_cast<std::size_t>(i) % kSystemCount],
                           static_cast<std::uint16_t>(1 + i / static_cast<int>(kSystemCount))};
    satellite.p_e = antenna_e_ + (kOrbit_m - kEarthSemiMajorAxis) * direction;
    satellite.elevation = elevation;
    satellite.azimuth = azimuth;
    satellite.wet_mapping = 1.0 / std::sin(elevation);
    satellite.arc = static_cast<std::uint32_t>(i + 1);
    keyframe_.satellites.push_back(satellite);
    Ambiguity ambiguity;
    ambiguity.arc = satellite.arc;
    ambiguity.satellite = satellite.satellite;
    keyframe_.state.ambiguities.push_back(ambiguity);
    // Codes and Dopplers on two frequencies, the carriers as a pair.
    for (const auto& [observable, sigma] : {std::pair{Observable::kCode, 1.0},
                                            {Observable::kCode, 1.0},
                                            {Observable::kCarrier, 0.01},
                                            {Observable::kDoppler, 0.1},
                                            {Observable::kDoppler, 0.1}}) {
      if (keyframe_.measurements.size() == kMaxMeasurements) return;
      KeyframeMeasurement m;
      m.measurement.satellite_index = static_cast<std::uint16_t>(i);
      m.measurement.observable = observable;
      m.measurement.sigma = sigma;
      m.variance = m.gain_variance = sigma * sigma;
      if (observable == Observable::kCarrier) m.ambiguity = i;
      if (observable != Observable::kDoppler)
        m.measurement.value = (satellite.p_e - antenna_e_).norm();
      keyframe_.measurements.push_back(m);
    }
  }

  double interval_s_;
  Eigen::Vector3d antenna_e_;
  KeyframeInput keyframe_;
};

}  // namespace

TimeToSolve time_to_solve(const NavigatorConfig& config) {
  if (config.motion == MotionModel::kInertial) return {config.realtime.smoother_deadline_s(), 1};
  return {keyframe_interval_s(config), std::max(1, config.smoother.max_iterations)};
}

SolveTime measure_solve_time(const NavigatorConfig& config) {
  SolveTime time;
  time.satellites = satellites_of(config.gnss);
  TimedMailbox<SmootherAnchor> mailbox;
  CountingSink sink;
  OneIteration budget;
  NavigatorConfig without_drill = config;
  without_drill.smoother.drill_failure_every = 0;
  const auto stage = std::make_unique<SmootherStage>(without_drill, &mailbox, &sink);
  const auto vehicle = std::make_unique<StandingVehicle>(config, time.satellites);
  std::array<double, kMeasuredSolves> solves_s{};
  for (int i = -config.smoother.window; i < kMeasuredSolves; ++i) {
    const KeyframeInput& keyframe = vehicle->next();
    if (i >= 0) mailbox.open(keyframe.index);  // otherwise it is added, not solved
    const int solved_before = sink.solved;
    const double before_s = thread_processor_s();
    stage->process(keyframe, &budget);
    if (i < 0) continue;
    solves_s[static_cast<std::size_t>(i)] = thread_processor_s() - before_s;
    time.solved += sink.solved - solved_before;
    SmootherAnchor taken;
    mailbox.take(keyframe.index, &taken);  // makes room for the next
  }
  std::nth_element(solves_s.begin(), solves_s.begin() + kMeasuredSolves / 2, solves_s.end());
  time.solve_s = solves_s[kMeasuredSolves / 2];
  return time;
}

void require_in_time(const NavigatorConfig& config, const SolveTime& time) {
  const TimeToSolve available = time_to_solve(config);
  const double needed_s = available.iterations * time.solve_s;
  if (needed_s <= 0.5 * available.limit_s) return;
  const RealtimeConfig& realtime = config.realtime;
  std::array<char, 640> text{};
  const int written = std::snprintf(
      text.data(), text.size(),
      "smoother.window: one iteration over %d keyframes with %d satellites takes %.1f ms of "
      "processor time on this machine; ",
      config.smoother.window, time.satellites, time.solve_s * 1e3);
  const auto used = static_cast<std::size_t>(written);
  if (config.motion == MotionModel::kInertial) {
    std::snprintf(text.data() + used, text.size() - used,
                  "that is more than half of the smoother's deadline of %.0f ms, the larger one of "
                  "realtime.deadline_smoother_ms (%.0f) and realtime.deadline_ekf_ms (%.0f); "
                  "shorten the window, lengthen the deadline or set estimator: ekf",
                  available.limit_s * 1e3, realtime.deadline_smoother_s * 1e3,
                  realtime.deadline_ekf_s * 1e3);
  } else {
    std::snprintf(text.data() + used, text.size() - used,
                  "smoother.max_iterations (%d) of them are more than half of the %.0f ms between "
                  "two keyframes, the larger one of realtime.epoch_interval_s (%g) and "
                  "smoother.keyframe_interval_s (%g), and without an IMU there is no deadline that "
                  "ends a solve; shorten the window, lengthen smoother.keyframe_interval_s or set "
                  "estimator: ekf",
                  available.iterations, available.limit_s * 1e3, realtime.epoch_interval_s,
                  config.smoother.keyframe_interval_s);
  }
  throw std::runtime_error(text.data());
}

}  // namespace leonav
