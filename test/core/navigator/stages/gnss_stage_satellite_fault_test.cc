// A satellite whose clock drifts away: it is found, told and left out, and the position keeps to
// its sigma.
#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kBegin_s = 120.0, kEnd_s = 420.0;

SyntheticDrive drifting(SatelliteId victim, double drift_m_s) {
  SyntheticDrive drive = drive_with_noise(kEnd_s);
  for (RawEpoch& raw : drive.epochs) {
    const double range_m = drift_m_s * std::max(seconds(raw.time) - kBegin_s, 0.0);
    for (SignalObservation& o : raw.observations) {
      if (o.satellite != victim || range_m == 0.0) continue;
      const double length_m = BandPlan().wavelength_m(o.satellite.system, o.code.band);
      o.pseudorange_m += range_m;
      o.carrier_cycles += range_m / length_m;
      o.doppler_hz -= drift_m_s / length_m;
    }
  }
  return drive;
}

int faults_told(const RecordingSink& sink, SatelliteId of) {
  return static_cast<int>(
      std::count_if(sink.events.begin(), sink.events.end(), [&](const Event& e) {
        return e.kind == EventKind::kSatelliteFault && e.code == index_of(of.system) &&
               e.value == of.number;
      }));
}

TEST_CASE("the stage reports and excludes a satellite whose clock drifts, and keeps its accuracy") {
  const RecordingSink clean = run(drifting({}, 0.0), config_with_carriers(drifting({}, 0.0)));
  for (const Event& event : clean.events) CHECK(event.kind != EventKind::kSatelliteFault);
  const auto& satellites = clean.epochs[clean.epochs.size() / 2].satellites;
  const SatelliteId victim =
      std::max_element(satellites.begin(), satellites.end(), [](const auto& a, const auto& b) {
        return a.elevation < b.elevation;
      })->satellite;
  const SyntheticDrive drive = drifting(victim, 0.02);
  const RecordingSink sink = run(drive, config_with_carriers(drive));
  CHECK(faults_told(sink, victim) == 1);
  int left_out = 0;
  for (const EpochReport& report : sink.epochs)
    for (const SatelliteReport& s : report.satellites)
      if (s.satellite == victim && s.reason == Reason::kFaulty) ++left_out;
  CHECK(left_out > 60);
  // The sigma grows in the epoch that tells it, by more than the satellite's loss explains later.
  const auto told = std::find_if(sink.events.begin(), sink.events.end(), [](const Event& e) {
    return e.kind == EventKind::kSatelliteFault;
  });
  REQUIRE(told != sink.events.end());
  for (std::size_t k = 1; k < sink.epochs.size(); ++k) {
    if (sink.epochs[k].time != told->time) continue;
    const auto growth = [k](const RecordingSink& of) {
      return of.epochs[k].solution.sigma_p_n.norm() / of.epochs[k - 1].solution.sigma_p_n.norm();
    };
    CAPTURE(growth(sink), growth(clean));
    CHECK(growth(clean) <= 1.0);
    CHECK(growth(sink) > 1.005);
    CHECK(growth(sink) < 3.0);
  }
  const double before = worst_error(clean, drive, kBegin_s, kEnd_s);
  const double with_fault = worst_error(sink, drive, kBegin_s, kEnd_s);
  CAPTURE(before, with_fault);
  CHECK(with_fault < before + 0.3);
}

}  // namespace
}  // namespace leonav::test
