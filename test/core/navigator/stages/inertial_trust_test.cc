// When an inertial prediction is believed against measurements that agree among each other.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kDuration_s = 180.0, kBurst_s = 120.0;

SyntheticDriveOptions noisy_drive(bool carriers) {
  SyntheticDriveOptions options;
  options.duration_s = kDuration_s;
  options.code_sigma_m = 1.0;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = carriers ? 0.003 : -1.0;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-3;
  return options;
}

NavigatorConfig config_of(const SyntheticDriveOptions& options) {
  NavigatorConfig config = drive_navigator_config(options);
  config.ekf.use_carrier = options.carrier_sigma_m >= 0.0;
  return config;
}

// Codes are those of a place `east_m` further east from `from_s` on, for `burst_s`; all else is
// right.
SyntheticDrive with_reflected_codes(const SyntheticDriveOptions& options, double from_s,
                                    double burst_s, double east_m = 30.0) {
  SyntheticDrive drive = synthetic_drive(options);
  SyntheticDriveOptions elsewhere = options;
  elsewhere.start.longitude += east_m / (6.378e6 * std::cos(options.start.latitude));
  const SyntheticDrive there = synthetic_drive(elsewhere);
  for (std::size_t k = 0; k < drive.epochs.size(); ++k) {
    const double t = seconds(drive.epochs[k].time) - from_s;
    if (t < 0.0 || t >= burst_s) continue;
    for (SignalObservation& o : drive.epochs[k].observations)
      for (const SignalObservation& other : there.epochs[k].observations)
        if (other.satellite == o.satellite && other.code == o.code)
          o.pseudorange_m = other.pseudorange_m;
  }
  return drive;
}

}  // namespace

TEST_CASE("codes that agree on a wrong place for ten seconds do not overthrow an IMU") {
  for (const bool carriers : {true, false}) {
    const SyntheticDriveOptions options = noisy_drive(carriers);
    const SyntheticDrive drive = with_reflected_codes(options, kBurst_s, 10.0);
    const RecordingSink sink = run(drive, config_of(options));
    const double before_m = worst_error(sink, drive, 60.0, kBurst_s - 0.5);
    const double after_m = worst_error(sink, drive, kBurst_s - 0.5, kDuration_s);
    std::printf("%s carriers: worst before the burst %.2f m, from it on %.2f m\n",
                carriers ? "with" : "without", before_m, after_m);
    CHECK(after_m < before_m + 1.0);
    CHECK(resets(sink).empty());
  }
}

TEST_CASE("codes that go on agreeing are believed in the end") {
  const SyntheticDriveOptions options = noisy_drive(true);
  const SyntheticDrive drive = with_reflected_codes(options, kBurst_s, 1e9);
  const RecordingSink sink = run(drive, config_of(options));
  CHECK(worst_error(sink, drive, kBurst_s, kBurst_s + 15.0) < 2.0);
  for (const EpochReport& report : sink.epochs)
    if (seconds(report.time) > kBurst_s + 30.0)
      CHECK(epoch_error(report, drive) == Approx(30.0).margin(3.0));
}

TEST_CASE("a filter that began where walls had put it is moved once all codes say so for long") {
  SyntheticDriveOptions options = noisy_drive(true);
  options.duration_s = 360.0;
  const SyntheticDrive drive = with_reflected_codes(options, 0.0, 90.0, 20.0);
  const RecordingSink sink = run(drive, config_of(options));
  CHECK(worst_error(sink, drive, 80.0, 200.0) > 15.0);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kPrediction});
  CHECK(worst_error(sink, drive, 300.0, 360.0) < 2.0);
}

// The three nearest GPS satellites as they are, the next three by way of walls from kBurst_s on for
// ten seconds: codes long, Dopplers and carriers off, arcs anew. No others.
SyntheticDrive with_street_corner(const SyntheticDriveOptions& options) {
  SyntheticDrive drive = synthetic_drive(options);
  for (RawEpoch& raw : drive.epochs) {
    const double t = seconds(raw.time) - kBurst_s;
    if (t < 0.0 || t >= 10.0) continue;
    auto& all = raw.observations;
    std::vector<double> ranges_m;
    for (const SignalObservation& o : all)
      if (o.satellite.system == System::kGps && o.code.band == '1')
        ranges_m.push_back(o.pseudorange_m);
    std::sort(ranges_m.begin(), ranges_m.end());
    REQUIRE(ranges_m.size() > 6);
    const double direct_m = ranges_m[2] + 100.0, reflected_m = ranges_m[5] + 100.0;
    const auto unseen = [&](const SignalObservation& o) {
      return o.satellite.system != System::kGps || o.pseudorange_m > reflected_m;
    };
    all.erase(std::remove_if(all.begin(), all.end(), unseen), all.end());
    for (SignalObservation& o : all) {
      if (o.pseudorange_m <= direct_m) continue;
      const double way_m = 15.0 + 6.0 * (o.satellite.number % 3);
      const double rate_m_s = o.satellite.number % 2 == 0 ? 2.5 : -2.7;
      const double cycle_m = wavelength_m(System::kGps, o.code.band);
      o.pseudorange_m += way_m;
      o.carrier_cycles += (way_m + rate_m_s * t) / cycle_m;
      o.doppler_hz -= rate_m_s / cycle_m;
      o.lock_time_s = std::max(t, 0.0);
    }
  }
  return drive;
}

TEST_CASE("beside a corner three carriers that moved as the IMU says outweigh what walls sent") {
  const SyntheticDriveOptions options = noisy_drive(true);
  const SyntheticDrive drive = with_street_corner(options);
  const RecordingSink sink = run(drive, config_of(options));
  const double worst_m = worst_error(sink, drive, kBurst_s, kDuration_s);
  std::printf("beside a corner: worst %.2f m\n", worst_m);
  CHECK(worst_m < 3.0);
}

TEST_CASE("Dopplers alone that agree once on another velocity do not overthrow an IMU") {
  const SyntheticDriveOptions options = noisy_drive(false);
  SyntheticDriveOptions faster = options;
  faster.turn_rate_rad_s *= 1.5;
  SyntheticDrive drive = synthetic_drive(options);
  const SyntheticDrive other = synthetic_drive(faster);
  const auto hit = static_cast<std::size_t>(kBurst_s);
  REQUIRE(drive.epochs[hit].observations.size() == other.epochs[hit].observations.size());
  for (std::size_t i = 0; i < drive.epochs[hit].observations.size(); ++i)
    drive.epochs[hit].observations[i].doppler_hz = other.epochs[hit].observations[i].doppler_hz;
  const NavState truth = drive.truth_at(drive.epochs[hit].time);
  REQUIRE((other.truth_at(truth.time).v_e - truth.v_e).norm() > 4.0);
  const RecordingSink sink = run(drive, config_of(options));
  CHECK(worst_error(sink, drive, kBurst_s, kBurst_s + 10.0) < 1.5);
}

// Of the turn that it misses the heading knows nothing afterwards: that is for the alignment.
TEST_CASE("an IMU that fails is not believed against what measures its motion") {
  for (const bool carriers : {true, false}) {
    const SyntheticDriveOptions options = noisy_drive(carriers);
    SyntheticDrive drive = synthetic_drive(options);
    ImuSample frozen;
    for (ImuSample& sample : drive.imu) {
      const double t = seconds(sample.time) - kBurst_s;
      if (t < 0.0) frozen = sample;
      if (t < 0.0 || t >= 10.0) continue;
      sample.delta_theta_b =
          frozen.delta_theta_b + Eigen::Vector3d::Constant(1e-3 * sample.interval_s());
      sample.delta_velocity_b.setZero();
    }
    const RecordingSink sink = run(drive, config_of(options));
    const double during_m = worst_error(sink, drive, kBurst_s, kBurst_s + 12.0);
    std::printf("%s carriers: worst while the IMU fails %.2f m\n", carriers ? "with" : "without",
                during_m);
    CHECK(during_m < (carriers ? 2.0 : 20.0));
  }
}

}  // namespace leonav::test
