// Events of inputs that do not follow a convention, through all stages. Each mistake by itself is
// tested in test/core/installation_checks.
#include <utility>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// A noise-free drive with a mistake in it.
struct Mistaken {
  SyntheticDrive drive;
  NavigatorConfig config;
  explicit Mistaken(double duration_s = 90.0) : Mistaken(drive_of(duration_s)) {}
  explicit Mistaken(SyntheticDrive of)
      : drive(std::move(of)), config(drive_navigator_config(drive.options)) {}

  template <typename Change>
  void imu(Change change) {
    for (ImuSample& sample : drive.imu) change(&sample);
  }
  template <typename Change>
  void epochs(Change change) {
    for (RawEpoch& epoch : drive.epochs) change(&epoch);
  }
  // Of the suspicions told: the convention; none: nothing was told; it must not be more than one.
  // What the Sequencer finds it may tell again each minute.
  Convention told() const {
    const RecordingSink sink = run(drive, config);
    const Event* last = nullptr;
    for (const Event& event : sink.events) {
      if (event.kind != EventKind::kConventionSuspect) continue;
      if (last != nullptr) {
        CHECK(event.stage == Stage::kSequencer);
        CHECK(event.code == last->code);
        CHECK(seconds_between(event.time, last->time) > kFoundAgain_s - 1.0);
      }
      last = &event;
    }
    return last == nullptr ? Convention::kNone : static_cast<Convention>(last->code);
  }
};

TEST_CASE("a right drive passes without a suspicion") {
  CHECK(Mistaken(300.0).told() == Convention::kNone);
}

TEST_CASE("an IMU of other axes, units or stamps is told as one mistake") {
  Mistaken up;
  up.imu([](ImuSample* sample) {
    sample->delta_theta_b.tail<2>() *= -1.0;
    sample->delta_velocity_b.tail<2>() *= -1.0;
  });
  const Convention found = up.told();
  CHECK((found == Convention::kForwardLeftUp || found == Convention::kThirdAxisUp));

  Mistaken in_g;
  in_g.imu([](ImuSample* sample) { sample->delta_velocity_b /= 9.80665; });
  CHECK(in_g.told() == Convention::kForceInG);

  Mistaken rates;
  rates.imu([](ImuSample* sample) {
    sample->delta_theta_b /= sample->interval_s();
    sample->delta_velocity_b /= sample->interval_s();
  });
  CHECK(rates.told() == Convention::kRatesAsIncrements);

  Mistaken mounted;
  mounted.imu([](ImuSample* sample) { sample->delta_theta_b.z() *= -1.0; });
  CHECK(mounted.told() == Convention::kGyroSign);
}

TEST_CASE("of a parked car axes that point up are told too, of what a hand holds they are not") {
  SyntheticDriveOptions options;
  options.duration_s = options.standstill_s = 130.0;
  Mistaken parked(synthetic_drive(options));
  parked.config.vehicle.kind = VehicleKind::kCar;
  CHECK(parked.told() == Convention::kNone);
  parked.imu([](ImuSample* sample) {
    sample->delta_theta_b.tail<2>() *= -1.0;
    sample->delta_velocity_b.tail<2>() *= -1.0;
  });
  CHECK(parked.told() == Convention::kThirdAxisUp);
  parked.config.vehicle.kind = VehicleKind::kHandheld;
  CHECK(parked.told() == Convention::kNone);
}

TEST_CASE("epochs and samples in UTC: the codes agree 18 s later") {
  Mistaken utc(60.0);
  utc.imu([](ImuSample* sample) { sample->time = sample->time.plus_seconds(-18.0); });
  utc.epochs([](RawEpoch* epoch) { epoch->time = epoch->time.plus_seconds(-18.0); });
  CHECK(utc.told() == Convention::kLeapSeconds);
}

TEST_CASE("without an IMU Dopplers are judged too") {
  Mistaken doppler(60.0);
  doppler.config.motion = MotionModel::kConstantVelocity;
  CHECK(doppler.told() == Convention::kNone);
  doppler.epochs([](RawEpoch* epoch) {
    for (SignalObservation& observation : epoch->observations) observation.doppler_hz *= -1.0;
  });
  CHECK(doppler.told() == Convention::kDopplerSign);
}

TEST_CASE("a restart forgets what was seen, and tells it once more") {
  Mistaken in_g;
  in_g.imu([](ImuSample* sample) { sample->delta_velocity_b /= 9.80665; });
  RecordingSink sink;
  Navigator pipeline(in_g.config, &sink);
  int epochs = 0;
  feed(in_g.drive, &pipeline, [&](const RawEpoch&, Sequencer* sequencer) {
    if (++epochs == 45) sequencer->on_command(Command());
  });
  CHECK(sink.count(EventKind::kConventionSuspect) == 2);
}

}  // namespace
}  // namespace leonav::test
