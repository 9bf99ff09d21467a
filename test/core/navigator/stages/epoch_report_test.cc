#include "core/navigator/stages/internal/epoch_report.h"

#include <algorithm>
#include <memory>

#include "core/gnss/measurement/dop.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {
namespace {

TEST_CASE("the reported DOP leaves out what the filter rejected") {
  const SimulatedReceiver receiver;
  SimulatedSky sky;
  sky.add(gps_walker());
  const GnssConfig config = default_gnss_config();
  RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  const auto epoch = std::make_unique<MeasurementEpoch>();
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get());
  REQUIRE(epoch->measurements.size() >= 12);

  // The verdict stands in the filter's result alone: the epoch's own reasons say "used".
  const Measurement& rejected = epoch->measurements.front();
  REQUIRE(rejected.observable == Observable::kCode);
  const SatelliteId outlier = epoch->satellites[rejected.satellite_index].satellite;
  EkfUpdateResult result;
  result.innovations.resize(epoch->measurements.size());
  for (std::size_t i = 0; i < result.innovations.size(); ++i) {
    const SatelliteId id = epoch->satellites[epoch->measurements[i].satellite_index].satellite;
    result.innovations[i].reason = id == outlier ? Reason::kOutlier : Reason::kUsed;
  }
  const auto report = std::make_unique<EpochReport>();
  start_report(1, epoch->time, false, report.get());
  report_update(*epoch, result, receiver.p_e, report.get());

  const double with_it = dilution_of_precision(*epoch, receiver.p_e).pdop;
  auto& kept = raw.observations;
  kept.erase(std::remove_if(kept.begin(), kept.end(),
                            [&](const auto& o) { return o.satellite == outlier; }),
             kept.end());
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get());
  const Dop without = dilution_of_precision(*epoch, receiver.p_e);
  CHECK(without.pdop > 1.01 * with_it);
  CHECK(report->pdop == Approx(without.pdop).epsilon(1e-9));
  CHECK(report->hdop == Approx(without.hdop).epsilon(1e-9));
  CHECK(report->vdop == Approx(without.vdop).epsilon(1e-9));
  for (const SatelliteReport& satellite : report->satellites) {
    if (satellite.satellite == outlier) CHECK(satellite.reason == Reason::kOutlier);
    if (satellite.satellite != outlier && is_used(satellite.reason)) CHECK(satellite.elevation > 0);
  }
}

}  // namespace
}  // namespace leonav::test
