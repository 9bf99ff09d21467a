// What becomes of the carriers of a phone, which break constantly: printed, as no truth tells which
// of its slips are real.
#include "support/catch.h"
#include "support/recorded/dataset.h"
#include "support/slips/slip_table.h"

namespace leonav {

TEST_CASE("Arcs of a phone's carriers", "[cycle_slip][data]") {
  if (!test::have_shared_data("drive/gnss.obs")) return;
  const test::Dataset data = test::read_drive(true);
  test::Feed feed(data, EphemerisConfig{});
  std::vector<std::map<SatelliteId, test::Prediction>> predictions;
  for (const RawEpoch& raw : data.epochs) {
    auto& of_epoch = predictions.emplace_back();
    const auto truth = test::truth_at(data, raw.time);
    const EphemerisStore& ephemeris_store = feed.at(raw.time);
    if (!truth) continue;
    for (const SignalObservation& o : raw.observations) {
      const auto prediction =
          test::predict_by_catalog(ephemeris_store, o.satellite, raw.time, o.pseudorange_m, *truth);
      if (prediction) of_epoch[o.satellite] = *prediction;
    }
  }
  test::SlipScene scene;
  scene.epochs = data.epochs;
  scene.predict = [&](std::size_t k, SatelliteId id, double) -> std::optional<test::Prediction> {
    const auto found = predictions[k].find(id);
    if (found == predictions[k].end()) return std::nullopt;
    return found->second;
  };
  scene.prior.change_covariance = 0.01 * Eigen::Matrix3d::Identity();
  scene.prior.change_is_free = false;
  scene.carrier_sigma_m = 0.01;
  scene.second_signals = false;
  CycleSlipConfig config;
  config.doppler_sigma_m_s = 0.2;
  for (const bool geometry : {false, true}) {
    scene.use_range_change = geometry;
    test::SlipRun run(scene, config);
    const test::SlipCounts counts = run.run();
    const long broken = counts.arcs - counts.first_arcs;
    std::cout << "Phone, L1 and E1, " << (geometry ? "with" : "without")
              << " range change: " << counts.satellite_epochs
              << " satellite-epochs above 15 degrees, " << run.going().size()
              << " of them continue an arc\n";
    test::print_ends(counts);
    CHECK(counts.satellite_epochs > 1000);
    CHECK(run.going().size() > 100);
    CHECK(broken > 0);
  }
}

}  // namespace leonav
