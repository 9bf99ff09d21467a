// No heap allocation with a full sky, precise orbits coming in and every kind of reset.
#include <array>
#include <cmath>
#include <random>

#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav::test {
namespace {

struct FullSkySink : OutputSink {
  std::size_t solutions = 0, epochs = 0, resets = 0, full_epochs = 0, precise = 0, arcs = 0,
              carriers = 0, epochs_of_30 = 0, solved = 0, checkpoints = 0, faults = 0,
              to_single = 0, to_pairs = 0;
  bool pairs = true;
  void on_solution(const Solution&) override { ++solutions; }
  void on_epoch(const EpochReport& report) override {
    ++epochs;
    if (report.satellites.size() >= 40) ++full_epochs;
    for (const SatelliteReport& s : report.satellites) {
      if (s.source == OrbitSource::kPrecise && s.reason == Reason::kUsed) ++precise;
      if (s.arc_started) ++arcs;
    }
    std::size_t pairs_here = 0, codes_here = 0;
    for (const AidingReport& a : report.aiding) {
      if (a.observable != Observable::kCode) continue;
      ++codes_here;
      pairs_here += a.second_code.is_set() ? 1 : 0;
    }
    if (codes_here > 0 && pairs != (pairs_here > 0)) {
      pairs = !pairs;
      ++(pairs ? to_pairs : to_single);
    }
    std::size_t here = 0;
    std::array<bool, kSystemCount> systems{};
    for (const AidingReport& a : report.aiding) {
      if (a.observable != Observable::kCarrier || a.reason != Reason::kUsed) continue;
      ++here;
      systems[index_of(a.satellite.system)] = true;
    }
    carriers += here;
    const bool three = systems[index_of(System::kGps)] && systems[index_of(System::kGalileo)] &&
                       systems[index_of(System::kBeidou)];
    if (here >= 30 && three) ++epochs_of_30;
  }
  void on_event(const Event& event) override {
    if (event.kind == EventKind::kFilterReset) ++resets;
    if (event.kind == EventKind::kCheckpoint) ++checkpoints;
    if (event.kind == EventKind::kSatelliteFault) ++faults;
  }
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport& report) override {
    if (report.status == SmootherStatus::kOk) ++solved;
  }
};

Walker dense_leo() { return {System::kLeo, 16, 24, 7'478e3, 0.96, 0.001}; }

NavigatorConfig full_config(MotionModel motion) {
  NavigatorConfig config;
  config.motion = motion;
  config.gnss = default_gnss_config();
  for (SystemConfig& system : config.gnss.systems) system.enabled = true;
  config.vehicle.lever_arm_b = SyntheticDriveOptions().lever_arm_b;
  config.imu = drive_navigator_config(SyntheticDriveOptions()).imu;
  config.ekf.use_carrier = true;
  config.ekf.wet_delay_sigma_m = 0.1;
  config.ekf.prediction_suspect_ratio = 1e9;  // or the filter would not need to be restarted
  return config;
}

// Everything that a car has, and an IMU that asks the carriers whether it stands.
void make_a_car(NavigatorConfig* config) {
  MotionConstraintConfig& constraints = config->vehicle.motion.constraints;
  constraints.non_holonomic = constraints.zero_velocity = true;
  config->imu.accel_bias = {0.2, 1000.0};
  AlignmentConfig& alignment = config->alignment;
  alignment.velocity_matching = alignment.heading_watch = true;
  alignment.max_reverse_speed_m_s = 5.0;
  alignment.lever_arm_b = config->vehicle.lever_arm_b;
  config->ekf.vehicle.count = ekf_index::kMaxVehicle;
  config->ekf.vehicle.sigma.fill(0.02);
}

// Nodes of every GPS satellite, 300 s apart, more than are kept.
std::vector<PreciseState> precise_states(const SimulatedSky& sky) {
  std::vector<PreciseState> states;
  for (int node = -5; node < static_cast<int>(kMaxOrbitNodes) + 5; ++node) {
    const GpsTime time = kSkyEpoch.plus_seconds(300.0 * node);
    for (const Ephemeris& e : sky.ephemerides) {
      if (e.satellite.system != System::kGps) continue;
      const SatelliteState state = broadcast_state(e, time);
      states.push_back({e.satellite, time, state.p_e, state.clock_s});
    }
  }
  return states;
}

TEST_CASE(
    "forty satellites and more, carriers that slip, precise orbits, outages, resets: no "
    "allocation") {
  SyntheticDriveOptions options;
  options.duration_s = 100.0;
  options.carrier_sigma_m = 0.002;
  options.slip_probability = 0.01;
  SimulatedSky sky;
  sky.add(gps_walker());
  sky.add(galileo_walker());
  sky.add({System::kBeidou, 3, 10, 27'906e3, 0.96, 0.0005});
  sky.add(dense_leo());
  SyntheticDrive drive;
  drive.options = options;
  drive.ephemerides = sky.ephemerides;
  drive.imu = synthetic_imu(options);
  drive.epochs = synthetic_epochs(options, sky);
  SyntheticDriveOptions there = options;  // carried away at 60 s
  there.start.longitude += 1e-3;
  const std::vector<RawEpoch> moved = synthetic_epochs(there, sky);
  for (std::size_t k = 60; k < drive.epochs.size(); ++k) drive.epochs[k] = moved[k];
  std::erase_if(drive.epochs, [](const RawEpoch& raw) {
    const double t = seconds_between(raw.time, kSkyEpoch);
    return t > 40.5 && t < 50.5;
  });
  const std::vector<PreciseState> states = precise_states(sky);
  const MotionModel motion = GENERATE(MotionModel::kInertial, MotionModel::kConstantVelocity);
  const Estimator estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  CAPTURE(static_cast<int>(motion), static_cast<int>(estimator));
  NavigatorConfig config = full_config(motion);
  config.estimator = estimator;
  if (GENERATE(false, true)) make_a_car(&config);
  config.vehicle.motion.constraints.odometer = true;
  config.ekf.vehicle.sigma[ekf_index::kOdometerScale] = 0.03;
  FullSkySink sink;
  Navigator pipeline(config, &sink);
  Checkpoint checkpoint{kSkyEpoch, true, to_ecef(options.start),  1.0,
                        0.5,       0.05, Eigen::Vector3d::Zero(), 1e-4};
  checkpoint.calibration.emplace();
  std::size_t next_state = 0, seen = 0;
  start_counting_allocations();
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    PreciseStates message;
    for (int i = 0; i < 40 && next_state < states.size(); ++i) {
      message.push_back(states[next_state++]);
    }
    sequencer->on_precise_states(message);
    for (int i = 1; i <= 10; ++i)
      sequencer->on_odometer(
          {raw.time.plus_nanoseconds((i - 10) * 100'000'000LL), 100'000'000, 0.8, i % 2 == 0});
    AntennaPattern antenna;
    antenna.satellite = {System::kGps, static_cast<std::uint16_t>(1 + seen % 30)};
    antenna.band = '1';
    sequencer->on_antenna(antenna);
    if (++seen == 75) sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
    if (seen == 1 || seen == 77) sequencer->on_checkpoint(checkpoint);
    if (seen == 80) sequencer->on_command({CommandKind::kSetHeading, 0.5, 0.1});
  });
  // Time itself leaps, in both streams.
  for (int i = 0; i < 40; ++i) {
    ImuSample sample = drive.imu[static_cast<std::size_t>(i)];
    sample.time = sample.time.plus_seconds(7200.0);
    pipeline.sequencer().on_imu(sample);
  }
  const std::size_t allocations = stop_counting_allocations();
  CHECK(allocations == 0);
  CHECK(next_state == states.size());
  CHECK(sink.full_epochs > 80);
  CHECK(sink.precise > 100);
  CHECK(sink.resets >= 2);
  // Of the heading twice, and of the calibration at the first attitude.
  CHECK(sink.checkpoints == (motion == MotionModel::kInertial ? 3 : 0));
  CHECK(sink.solutions > 80);
  CHECK(sink.carriers > 1000);
  CHECK(sink.arcs > 60);
  CHECK((sink.solved > 60) == (estimator == Estimator::kSmoother));
}

// The sky that leonav-bench measures: tools/scripts/speed.
TEST_CASE("thirty satellites of three systems on two frequencies, 200 Hz IMU: no allocation") {
  SyntheticDriveOptions options = full_sky({});
  options.duration_s = 60.0;
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.002;
  options.slip_probability = 0.02;
  const SyntheticDrive drive = synthetic_drive(options);
  FullSkySink sink;
  NavigatorConfig config = full_config(MotionModel::kInertial);
  config.estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  Navigator pipeline(config, &sink);
  start_counting_allocations();
  feed(drive, &pipeline);
  CHECK(stop_counting_allocations() == 0);
  CHECK(sink.epochs == 59);
  CHECK(sink.epochs_of_30 >= 50);
  CHECK(sink.arcs > 60);
}

// Half of the carriers slip at each epoch, and codes are off by some 12 m.
void pass_a_street(std::mt19937_64* bits, RawEpoch* raw) {
  std::normal_distribution<double> normal;
  for (SignalObservation& o : raw->observations) {
    o.pseudorange_m += 12.0 * normal(*bits);
    if ((*bits)() % 2 == 0) o.carrier_cycles += 1000.0;
    o.loss_of_lock = (*bits)() % 2 == 0;
  }
}

TEST_CASE("leaving a satellite out and changing how codes are combined allocates nothing") {
  SyntheticDriveOptions options;
  options.duration_s = 430.0;
  options.imu_rate_hz = 20.0;
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  SyntheticDrive drive = synthetic_drive(options);
  const SatelliteId drifting = drive.epochs.front().observations.front().satellite;
  std::mt19937_64 bits(9);
  for (RawEpoch& raw : drive.epochs) {
    const double t = seconds(raw.time);
    const double range_m = 0.02 * std::max(t - 100.0, 0.0);
    for (SignalObservation& o : raw.observations) {
      if (o.satellite != drifting) continue;
      o.pseudorange_m += range_m;
      o.carrier_cycles += range_m / BandPlan().wavelength_m(o.satellite.system, o.code.band);
    }
    if (t > 320.0 && t < 350.0) pass_a_street(&bits, &raw);
  }
  FullSkySink sink;
  Navigator pipeline(full_config(MotionModel::kInertial), &sink);
  start_counting_allocations();
  feed(drive, &pipeline);
  CHECK(stop_counting_allocations() == 0);
  CHECK(sink.faults == 1);
  CHECK(sink.to_single == 1);
  CHECK(sink.to_pairs == 1);
}

}  // namespace
}  // namespace leonav::test
