// Ranges that stay wrong by another amount for each satellite, as with orbits of another day: it is
// told, and the sigma is as large as the error.
#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kLongDrive_s = 1000.0;

// Until `end_s`.
SyntheticDrive with_wrong_ranges(double size_m, double end_s) {
  SyntheticDrive drive = drive_with_noise(kLongDrive_s);
  for (RawEpoch& raw : drive.epochs)
    for (SignalObservation& o : raw.observations) {
      if (seconds(raw.time) >= end_s) continue;
      const int third = (o.satellite.number + 2 * static_cast<int>(o.satellite.system)) % 3;
      const double range_m = size_m * (third - 1);
      o.pseudorange_m += range_m;
      o.carrier_cycles += range_m / BandPlan().wavelength_m(o.satellite.system, o.code.band);
    }
  return drive;
}

NavigatorConfig learning_config(const SyntheticDrive& drive) {
  NavigatorConfig config = config_with_carriers(drive);
  config.ekf.learn_errors = true;
  return config;
}

bool is_of_orbits(const Event& event) {
  return event.kind == EventKind::kConventionSuspect &&
         event.code == static_cast<std::uint8_t>(Convention::kOrbits);
}

int told(const RecordingSink& sink) {
  return static_cast<int>(std::count_if(sink.events.begin(), sink.events.end(), is_of_orbits));
}

// 3D, m, at the first epoch from `t` on.
double sigma_at(const RecordingSink& sink, double t) {
  for (const EpochReport& report : sink.epochs)
    if (seconds(report.time) >= t) return report.solution.sigma_p_n.norm();
  return 0.0;
}

TEST_CASE("orbits that are wrong by tens of metres are told, and the sigma holds from then on") {
  const SyntheticDrive clean = with_wrong_ranges(0.0, kLongDrive_s);
  CHECK(told(run(clean, learning_config(clean))) == 0);
  const bool mended = GENERATE(false, true);
  CAPTURE(mended);
  const SyntheticDrive drive = with_wrong_ranges(30.0, mended ? 400.0 : kLongDrive_s);
  const RecordingSink sink = run(drive, learning_config(drive));
  CHECK(told(sink) >= 1);
  CHECK(told(sink) <= 3);
  const auto first = std::find_if(sink.events.begin(), sink.events.end(), is_of_orbits);
  REQUIRE(first != sink.events.end());
  CHECK(seconds(first->time) < 300.0);
  double worst_m = 0.0;
  for (double t = 320.0; t < (mended ? 400.0 : kLongDrive_s - 10.0); t += 10.0) {
    const double error_m = worst_error(sink, drive, t, t + 10.0);
    worst_m = std::max(worst_m, error_m);
    const double sigma_m = sigma_at(sink, t);
    CAPTURE(t, error_m, sigma_m);
    CHECK(error_m < 3.0 * sigma_m);
    CHECK(sigma_m < 150.0);
  }
  CHECK(worst_m > 3.0);
  CHECK(sigma_at(sink, kLongDrive_s - 5.0) < (mended ? 10.0 : 150.0));
  CHECK((sigma_at(sink, kLongDrive_s - 5.0) > 10.0) == !mended);
}

TEST_CASE("a smoother's window goes on where wrong orbits end all ambiguities") {
  const SyntheticDrive drive = with_wrong_ranges(30.0, kLongDrive_s);
  NavigatorConfig config = learning_config(drive);
  config.estimator = Estimator::kSmoother;
  const RecordingSink sink = run(drive, config);
  CHECK(told(sink) >= 1);
  const auto good = std::count_if(
      sink.smoothed.begin(), sink.smoothed.end(),
      [](const SmootherReport& report) { return report.status == SmootherStatus::kOk; });
  CAPTURE(good, sink.smoothed.size());
  CHECK(good > 0.9 * kLongDrive_s);
}

}  // namespace
}  // namespace leonav::test
