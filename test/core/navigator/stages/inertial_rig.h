// InertialRig runs an InertialNavigator whose anchors are the truth or lie a given distance from
// it.
#pragma once
#include <cstdint>

#include "core/navigator/stages/inertial_navigator.h"
#include "support/drive/synthetic_drive.h"
#include "support/stages/recording_sink.h"

namespace leonav::test {

// InertialRig has no filter: a test delivers the anchors through the mailbox itself.
struct InertialRig {
  NavigatorConfig config;
  SyntheticDrive drive;
  RecordingSink sink;
  TimedMailbox<Anchor> mailbox;
  InertialNavigator navigator;

  explicit InertialRig(double duration_s = 30.0, const NavigatorConfig& c = NavigatorConfig())
      : config(c), drive(make_drive(duration_s)), navigator(c, &mailbox, nullptr, &sink) {}

  static SyntheticDrive make_drive(double duration_s) {
    SyntheticDriveOptions options;
    options.duration_s = duration_s;
    options.standstill_s = 0.0;
    options.first_epoch_s = duration_s + 1.0;  // no raw epochs
    SyntheticDrive drive;
    drive.options = options;
    drive.imu = synthetic_imu(options);
    return drive;
  }
  // Returns an anchor at the truth `t` seconds after the start, moved by `offset_m` along ECEF x.
  Anchor anchor(std::uint64_t index, double t, double offset_m = 0.0) const {
    Anchor update;
    update.index = index;
    update.valid = update.has_attitude = update.gnss_used = true;
    update.state = drive.truth_at(kSkyEpoch.plus_seconds(t));
    update.state.p_e.x() += offset_m;
    update.covariance.diagonal().head<3>().setConstant(1.0);
    update.covariance.diagonal().segment<3>(3).setConstant(0.01);
    update.covariance.diagonal().segment<3>(6).setConstant(1e-6);
    return update;
  }
  // Issues an epoch of time `t` now, with its deadline `deadline_s` after `t`.
  void issue(std::uint64_t index, double t, double deadline_s) {
    mailbox.open(index);
    const GpsTime time = kSkyEpoch.plus_seconds(t);
    navigator.process(EpochIssued{index, time, time.plus_seconds(deadline_s), {}});
  }
  // Feeds the IMU samples with stamps in (from_s, to_s], in seconds after the start.
  void feed(double from_s, double to_s) {
    for (const ImuSample& sample : drive.imu) {
      const double t = seconds_between(sample.time, kSkyEpoch);
      if (t > from_s + 1e-9 && t <= to_s + 1e-9) navigator.process(sample);
    }
  }
};

}  // namespace leonav::test
