// Ranges that stay wrong by another amount for each satellite, as with orbits of another day: it is
// told, and the sigma is as large as the error.
#include "support/catch.h"
#include "support/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kDuration_s = 600.0;

SyntheticDrive with_wrong_ranges(double size_m) {
  SyntheticDriveOptions options;
  options.duration_s = kDuration_s;
  options.code_sigma_m = 1.0;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  SyntheticDrive drive = synthetic_drive(options);
  for (RawEpoch& raw : drive.epochs)
    for (SignalObservation& o : raw.observations) {
      const int third = (o.satellite.number + 2 * static_cast<int>(o.satellite.system)) % 3;
      const double range_m = size_m * (third - 1);
      o.pseudorange_m += range_m;
      o.carrier_cycles += range_m / wavelength_m(o.satellite.system, o.code.band);
    }
  return drive;
}

NavigatorConfig config_of(const SyntheticDrive& drive) {
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.use_carrier = true;
  config.ekf.learn_errors = true;
  return config;
}

int told(const RecordingSink& sink) {
  return static_cast<int>(
      std::count_if(sink.events.begin(), sink.events.end(), [](const Event& event) {
        return event.kind == EventKind::kConventionSuspect &&
               event.code == static_cast<std::uint8_t>(Convention::kOrbits);
      }));
}

TEST_CASE("orbits that are wrong by tens of metres are told, and the sigma holds from then on") {
  const SyntheticDrive clean = with_wrong_ranges(0.0);
  CHECK(told(run(clean, config_of(clean))) == 0);
  const SyntheticDrive drive = with_wrong_ranges(30.0);
  const RecordingSink sink = run(drive, config_of(drive));
  CHECK(told(sink) >= 1);
  const auto first = std::find_if(sink.events.begin(), sink.events.end(), [](const Event& event) {
    return event.kind == EventKind::kConventionSuspect &&
           event.code == static_cast<std::uint8_t>(Convention::kOrbits);
  });
  REQUIRE(first != sink.events.end());
  CHECK(seconds(first->time) < 300.0);
  const double error_m = worst_error(sink, drive, 400.0, kDuration_s);
  const double sigma_m = sink.epochs.back().solution.sigma_p_n.norm();
  CAPTURE(error_m, sigma_m);
  CHECK(error_m > 3.0);
  CHECK(error_m < 3.0 * sigma_m);
  CHECK(sigma_m < 100.0);
}

}  // namespace
}  // namespace leonav::test
