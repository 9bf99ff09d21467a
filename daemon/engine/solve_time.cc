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
#include "daemon/threads/counters.h"

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

// Drops all outputs.
class NoSink final : public OutputSink {
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport&) override {}
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}
};

class OneIteration final : public SolveBudget {
  bool may_iterate(int) override { return false; }
};

// Keyframes of a vehicle that stands at zero latitude and longitude, its axes those of ECEF.
class StandingVehicle {
 public:
  StandingVehicle(const NavigatorConfig& config, int satellites)
      : interval_s_(
            std::max(config.smoother.keyframe_interval_s, config.realtime.epoch_interval_s)) {
    keyframe_.valid = true;
    keyframe_.follows_previous = true;
    keyframe_.has_attitude = true;
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

SolveTime measure_solve_time(const NavigatorConfig& config) {
  SolveTime time;
  time.satellites = satellites_of(config.gnss);
  TimedMailbox<SmootherAnchor> mailbox;
  NoSink sink;
  OneIteration budget;
  const auto stage = std::make_unique<SmootherStage>(config, &mailbox, &sink);
  const auto vehicle = std::make_unique<StandingVehicle>(config, time.satellites);
  std::array<double, kMeasuredSolves> solves_s{};
  for (int i = -config.smoother.window; i < kMeasuredSolves; ++i) {
    const KeyframeInput& keyframe = vehicle->next();
    if (i >= 0) mailbox.open(keyframe.index);  // otherwise it is added, not solved
    const Stopwatch watch;
    stage->process(keyframe, &budget);
    if (i < 0) continue;
    solves_s[static_cast<std::size_t>(i)] = static_cast<double>(watch.nanoseconds()) * 1e-9;
    SmootherAnchor taken;
    if (mailbox.take(keyframe.index, &taken) && taken.status == SmootherStatus::kOk) ++time.solved;
  }
  std::nth_element(solves_s.begin(), solves_s.begin() + kMeasuredSolves / 2, solves_s.end());
  time.solve_s = solves_s[kMeasuredSolves / 2];
  return time;
}

void require_in_time(const NavigatorConfig& config, const SolveTime& time) {
  const double deadline_s =
      std::max(config.realtime.deadline_ekf_s, config.realtime.deadline_smoother_s);
  if (time.solve_s <= 0.5 * deadline_s) return;
  std::array<char, 256> text{};
  std::snprintf(
      text.data(), text.size(),
      "smoother.window: one iteration over %d keyframes with %d satellites takes %.1f ms on this "
      "machine, more than half of realtime.deadline_smoother_ms (%.0f); shorten the window, "
      "lengthen the "
      "deadline or set estimator: ekf",
      config.smoother.window, time.satellites, time.solve_s * 1e3, deadline_s * 1e3);
  throw ConfigError(text.data());
}

}  // namespace leonav
