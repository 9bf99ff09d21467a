// Drives whose carriers slip: what carriers add to codes and Dopplers, and whether the sigmas hold.
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

struct ErrorCounts {
  int epochs = 0, within = 0;  // of three components each
  double squares = 0.0;
  double rms() const { return std::sqrt(squares / epochs); }
  double share() const { return within / (3.0 * epochs); }
};

enum class Orbits { kBroadcast, kPrecise };

// Broadcast clocks that are wrong by as much as the best message claims.
void disturb_clocks(SyntheticDrive* drive) {
  constexpr double kBestBroadcast_m = 0.5;
  std::mt19937_64 generator(drive->options.seed + 3);
  std::normal_distribution<double> normal;
  for (Ephemeris& e : drive->ephemerides)
    e.af0 += kBestBroadcast_m * normal(generator) / kSpeedOfLight;
}

void add_errors(const SyntheticDrive& drive, Orbits orbits, const NavigatorConfig& config,
                ErrorCounts* errors) {
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  ProductNodes product(drive.ephemerides, 30.0, 180.0);
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    if (orbits == Orbits::kPrecise) product.send_until(seconds(raw.time), sequencer);
  });
  const bool inertial = config.motion == MotionModel::kInertial;
  for (const EpochReport& report : sink.epochs) {
    const Solution& s = report.solution;
    if (s.source == Source::kNone || (inertial && !s.has_attitude)) continue;
    if (seconds_between(report.time, kSkyEpoch) < 60.0) continue;
    const double t = seconds_between(s.time, kSkyEpoch);
    const SyntheticPath path(drive.options);
    const Eigen::Vector3d truth_e = inertial ? path.state(t).p_e : path.antenna_p_e(t);
    const Eigen::Matrix3d C_ne = rotation_ecef_to_ned({s.latitude, s.longitude, s.height});
    const Eigen::Vector3d error_n = C_ne * (s.p_e - truth_e);
    ++errors->epochs;
    errors->squares += error_n.squaredNorm();
    for (int i = 0; i < 3; ++i)
      errors->within += std::abs(error_n(i)) <= 3.0 * s.sigma_p_n(i) ? 1 : 0;
  }
}

// Errors without carriers, and with.
std::array<ErrorCounts, 2> drive_errors(MotionModel motion, Orbits orbits) {
  std::array<ErrorCounts, 2> errors;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SyntheticDriveOptions options;
    options.duration_s = 240.0;
    options.code_sigma_m = 1.0;
    options.doppler_sigma_m_s = 0.05;
    options.carrier_sigma_m = 0.003;
    options.slip_probability = 0.002;  // a satellite every eight minutes
    options.angle_random_walk = 1e-4;
    options.velocity_random_walk = 1e-3;
    options.seed = 10 * seed;
    SyntheticDrive drive = synthetic_drive(options);
    if (orbits == Orbits::kBroadcast) disturb_clocks(&drive);
    NavigatorConfig config = drive_navigator_config(options, motion);
    add_errors(drive, orbits, config, &errors[0]);
    config.ekf.use_carrier = true;
    add_errors(drive, orbits, config, &errors[1]);
  }
  std::printf(
      "%s, %s orbits: code and Doppler %.3f m (3D rms), within 3 sigma %.2f %%; with carriers "
      "%.3f m, %.2f %% (%d epochs)\n",
      motion == MotionModel::kInertial ? "with IMU" : "GNSS only",
      orbits == Orbits::kPrecise ? "precise" : "broadcast", errors[0].rms(),
      100.0 * errors[0].share(), errors[1].rms(), 100.0 * errors[1].share(), errors[1].epochs);
  return errors;
}

}  // namespace

TEST_CASE("with carriers a drive is far better, whatever slips; sigmas hold") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    const auto [codes, with_carriers] = drive_errors(motion, Orbits::kPrecise);
    CHECK(with_carriers.epochs > 800);
    CHECK(with_carriers.rms() < 0.6 * codes.rms());
    CHECK(codes.share() > 0.98);
    CHECK(with_carriers.share() > 0.98);
  }
}

// What errs alike for the whole drive no carrier takes away. Without them codes are taken as new
// each epoch (models.md), so that only those with carriers must know how wrong they are.
TEST_CASE("broadcast clocks that err for the whole drive: with carriers the sigmas know it") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    const auto [codes, with_carriers] = drive_errors(motion, Orbits::kBroadcast);
    CHECK(with_carriers.epochs > 800);
    CHECK(with_carriers.rms() < 1.2 * codes.rms());
    CHECK(with_carriers.share() > 0.98);
  }
}

}  // namespace leonav::test
