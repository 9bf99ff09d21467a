// Bad messages in an otherwise good stream of LCM bytes, as the daemon and the replay take them in:
// each is counted by its reason, and the good data around it still count.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/navigator/navigator.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"
#include "support/drive/synthetic_drive.h"

namespace leonav::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Run final : OutputSink {
  std::vector<Solution> solutions;
  std::vector<EpochReport> epochs;
  std::vector<Event> events;
  Navigator navigator;
  InputDispatch dispatch;
  Encoder encoder;
  std::uint64_t count = 0;

  explicit Run(const NavigatorConfig& config)
      : navigator(config, this), dispatch(&navigator.sequencer()) {}
  void on_solution(const Solution& s) override { solutions.push_back(s); }
  void on_epoch(const EpochReport& e) override { epochs.push_back(e); }
  void on_event(const Event& e) override { events.push_back(e); }
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}

  void send(const ImuSample& s) { dispatch.dispatch(Channel::kImu, encoder.encode(s, ++count)); }
  void send(const RawEpoch& r) {
    dispatch.dispatch(Channel::kGnssEpoch, encoder.encode(r, ++count));
  }
  void send(const Ephemeris& e) {
    dispatch.dispatch(Channel::kEphemeris, encoder.encode(e, ++count));
  }
  void send(const OdometerIncrement& o) {
    dispatch.dispatch(Channel::kOdometer, encoder.encode(o, ++count));
  }
  std::uint64_t rejected(InputFault fault) const {
    return navigator.sequencer().counters().rejected[static_cast<std::size_t>(fault)];
  }
};

double seconds(GpsTime time) { return seconds_between(time, kSkyEpoch); }

struct Drive {
  SyntheticDrive data;
  NavigatorConfig config;
};

Drive make_drive() {
  SyntheticDriveOptions options;
  options.duration_s = 80.0;
  Drive drive;
  drive.data = synthetic_drive(options);
  drive.config.gnss = default_gnss_config();
  for (SystemConfig& system : drive.config.gnss.systems) system.enabled = true;
  drive.config.vehicle.lever_arm_b = options.lever_arm_b;
  drive.config.imu.angle_random_walk = 1e-4;
  drive.config.imu.velocity_random_walk = 1e-3;
  drive.config.imu.gyro_bias = {1e-4, 3600.0};
  drive.config.imu.accel_bias = {0.01, 3600.0};
  drive.config.imu.gyro_scale = {1e-4, 3600.0};
  drive.config.imu.accel_scale = {1e-4, 3600.0};
  return drive;
}

// `on_imu` and `on_epoch` send what they make of a message.
template <typename OnImu, typename OnEpoch>
void feed_changed(const Drive& drive, Run* run, OnImu on_imu, OnEpoch on_epoch) {
  feed(
      drive.data, 0.06, [&](const Ephemeris& e) { run->send(e); }, on_imu, on_epoch);
}

double worst_error(const Run& run, const Drive& drive, double from_s, double to_s) {
  double worst = 0.0;
  int count = 0;
  for (const Solution& s : run.solutions) {
    if (seconds(s.time) < from_s || seconds(s.time) > to_s || !s.has_attitude) continue;
    ++count;
    worst = std::max(worst, (s.p_e - drive.data.truth_at(s.time).p_e).norm());
  }
  return count > 100 ? worst : 1e9;
}

TEST_CASE("NaN in IMU, GNSS and ephemeris messages is counted, and costs the solution nothing") {
  const Drive drive = make_drive();
  Run run(drive.config);
  int bad_imu = 0, bad_epochs = 0;
  for (Ephemeris e : drive.data.ephemerides) {
    e.sqrt_a = kNan;
    run.send(e);
  }
  const auto bad_ephemerides = drive.data.ephemerides.size();
  feed_changed(
      drive, &run,
      [&](ImuSample s) {
        run.send(s);
        s.time = s.time.plus_nanoseconds(1'000'000);
        s.delta_velocity_b.y() = kNan;  // after every good one, a bad one
        run.send(s);
        ++bad_imu;
      },
      [&](RawEpoch r) {
        ++bad_epochs;
        for (SignalObservation& o : r.observations) {
          if (o.satellite == r.observations.front().satellite) {
            o.pseudorange_m = o.doppler_hz = o.cn0_dbhz = kNan;
          }
        }
        run.send(r);
      });
  CHECK(run.rejected(InputFault::kNotFinite) + run.rejected(InputFault::kNotSane) >=
        static_cast<std::uint64_t>(bad_imu) + bad_ephemerides);
  CHECK(run.navigator.sequencer().counters().imu == static_cast<std::uint64_t>(bad_imu));
  CHECK(run.navigator.sequencer().counters().epochs == static_cast<std::uint64_t>(bad_epochs));
  CHECK(run.navigator.sequencer().counters().ephemerides == bad_ephemerides);
  CHECK(worst_error(run, drive, 40.0, 80.0) < 0.2);
}

TEST_CASE("messages cut short or of another kind are counted as undecodable and cost nothing") {
  const Drive drive = make_drive();
  Run run(drive.config);
  Encoder other;
  int cut = 0;
  feed_changed(
      drive, &run,
      [&](const ImuSample& s) {
        run.send(s);
        const ByteSpan bytes = other.encode(s, 1);
        run.dispatch.dispatch(Channel::kImu, bytes.first(bytes.size() - 1));
        run.dispatch.dispatch(Channel::kGnssEpoch, bytes);
        cut += 2;
      },
      [&](const RawEpoch& r) { run.send(r); });
  CHECK(run.rejected(InputFault::kUndecodable) == static_cast<std::uint64_t>(cut));
  CHECK(worst_error(run, drive, 40.0, 80.0) < 0.1);
}

TEST_CASE("an odometer that sends nonsense is counted by its reasons and costs nothing") {
  Drive drive = make_drive();
  MotionConstraintConfig& motion = drive.config.vehicle.motion.constraints;
  motion.non_holonomic = motion.zero_velocity = motion.odometer = true;
  drive.config.ekf.vehicle = {2, {0.03, 0.03, 0.03}, {3e-5, 3e-5, 2e-5}};
  Run run(drive.config);
  Encoder other;
  const SyntheticPath path(drive.data.options);
  unsigned sent = 0, samples = 0;
  feed_changed(
      drive, &run,
      [&](const ImuSample& s) {
        run.send(s);
        if (++samples % 20 != 0) return;
        const double way = 0.1 * path.state(seconds(s.time) - 0.05).v_e.norm();
        const OdometerIncrement good{s.time, 100'000'000, way, true};
        run.send(good);
        run.send(good);
        OdometerIncrement bad = good;
        bad.time = s.time.plus_nanoseconds(1'000'000);
        bad.distance_m = kNan;
        run.send(bad);
        bad.distance_m = 1e6;
        run.send(bad);
        bad = good;
        bad.time = s.time.plus_seconds(-30.0 - (++sent % 2 == 0 ? 5.0 : 0.0));
        run.send(bad);
        const ByteSpan bytes = other.encode(good, 1);
        run.dispatch.dispatch(Channel::kOdometer, bytes.first(bytes.size() - 1));
        run.dispatch.dispatch(Channel::kImu, bytes);
      },
      [&](const RawEpoch& r) { run.send(r); });
  const auto& counters = run.navigator.sequencer().counters();
  CHECK(counters.odometer == sent);
  CHECK(counters.imu == samples);
  CHECK(run.rejected(InputFault::kDuplicate) == sent);
  CHECK(run.rejected(InputFault::kNotFinite) == sent);
  CHECK(run.rejected(InputFault::kOutOfRange) == sent);
  CHECK(run.rejected(InputFault::kTimeBackwards) == sent);
  CHECK(run.rejected(InputFault::kUndecodable) == 2 * sent);
  CHECK(worst_error(run, drive, 40.0, 80.0) < 0.2);
}

TEST_CASE("an IMU gap of three seconds is reported, and some seconds later all is well again") {
  const Drive drive = make_drive();
  Run run(drive.config);
  feed_changed(
      drive, &run,
      [&](const ImuSample& s) {
        if (seconds(s.time) > 50.0 && seconds(s.start()) < 53.0) return;
        run.send(s);
      },
      [&](const RawEpoch& r) { run.send(r); });
  CHECK(run.navigator.sequencer().counters().imu_gaps == 1);
  const auto gap = std::find_if(run.events.begin(), run.events.end(),
                                [](const Event& e) { return e.kind == EventKind::kImuGap; });
  REQUIRE(gap != run.events.end());
  CHECK(gap->value == Approx(3.0).margin(0.011));
  CHECK(worst_error(run, drive, 40.0, 49.9) < 0.1);
  for (const Solution& s : run.solutions) {
    if (seconds(s.time) < 53.0 || seconds(s.time) > 58.0) continue;
    CHECK((s.p_e - drive.data.truth_at(s.time).p_e).norm() < 4.0 * s.sigma_p_n.norm() + 0.1);
  }
  CHECK(worst_error(run, drive, 58.0, 80.0) < 0.5);
  CHECK(run.solutions.back().source == Source::kEkf);
}

TEST_CASE("IMU time that goes backwards is refused, sample by sample") {
  const Drive drive = make_drive();
  Run run(drive.config);
  int sent = 0;
  feed_changed(
      drive, &run,
      [&](const ImuSample& s) {
        run.send(s);
        if (++sent % 50 != 0) return;
        ImuSample old = s;  // never twenty in a row: that would be a clock that was set
        for (const double back_s : {0.1, 1.0, 3600.0}) {
          old.time = s.time.plus_seconds(-back_s);
          run.send(old);
        }
        run.send(s);
      },
      [&](const RawEpoch& r) { run.send(r); });
  CHECK(run.rejected(InputFault::kTimeBackwards) == 3u * static_cast<unsigned>(sent / 50));
  CHECK(run.rejected(InputFault::kDuplicate) == static_cast<unsigned>(sent / 50));
  CHECK(run.navigator.sequencer().counters().imu == static_cast<unsigned>(sent));
  CHECK(worst_error(run, drive, 40.0, 80.0) < 0.1);
}

TEST_CASE("GNSS time that goes backwards is refused, epoch by epoch") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    Drive drive = make_drive();
    drive.config.motion = motion;
    Run run(drive.config);
    unsigned sent = 0;
    feed_changed(
        drive, &run, [&](const ImuSample& s) { run.send(s); },
        [&](const RawEpoch& r) {
          run.send(r);
          ++sent;
          RawEpoch old = r;
          old.time = r.time.plus_seconds(-5.5);
          run.send(old);
          if (sent % 3 == 0) old.time = r.time.plus_seconds(-3600.0 - 10.0 * (sent % 2));
          run.send(old);
        });
    const Sequencer::Counters& counters = run.navigator.sequencer().counters();
    // Behind by less than ten seconds is late, by more is another time.
    CHECK(run.rejected(InputFault::kTimeBackwards) == sent / 3);
    CHECK(counters.late_epochs == 2 * sent - sent / 3);
    CHECK(counters.epochs == sent);
    CHECK(run.epochs.size() >= sent - 1);
    const EpochReport& last = run.epochs.back();
    CHECK(last.satellites_used >= 10);
    if (motion == MotionModel::kInertial) CHECK(worst_error(run, drive, 40.0, 80.0) < 0.1);
  }
}

}  // namespace
}  // namespace leonav::test
