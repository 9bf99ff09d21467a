// The detectors on six hours of a geodetic receiver, 30 s, into whose carriers slips are put.
#include "support/catch.h"
#include "support/dataset.h"
#include "support/slip_experiment.h"

namespace leonav {
namespace {

struct Station {
  test::Dataset data;
  test::SlipScene scene;
  std::vector<std::map<SatelliteId, test::Prediction>> predictions;
};

Station read() {
  Station station;
  station.data = test::read_station(true);
  test::Feed feed(station.data, CatalogOptions{});
  const Eigen::Vector3d antenna = test::station_antenna();
  for (const RawEpoch& raw : station.data.epochs) {
    auto& of_epoch = station.predictions.emplace_back();
    const SatelliteCatalog& catalog = feed.at(raw.time);
    for (const SignalObservation& o : raw.observations) {
      if (of_epoch.count(o.satellite) > 0) continue;
      const auto prediction =
          test::predict_by_catalog(catalog, o.satellite, raw.time, o.pseudorange_m, antenna);
      if (prediction) of_epoch[o.satellite] = *prediction;
    }
  }
  station.scene.epochs = station.data.epochs;
  station.scene.clock_walk_m = 0.0015;
  return station;
}

}  // namespace

TEST_CASE("Slips in a geodetic receiver's carriers are found", "[cycle_slip][data]") {
  if (!test::have_shared_data("station/ESBC00DNK_2020177_6H_30S.obs")) return;
  Station station = read();
  station.scene.predict = [&](std::size_t k, SatelliteId id,
                              double) -> std::optional<test::Prediction> {
    const auto found = station.predictions[k].find(id);
    if (found == station.predictions[k].end()) return std::nullopt;
    return found->second;
  };
  const CycleSlipConfig config;
  struct Mode {
    const char* name;
    bool range_change, free;
  };
  test::print_heading();
  for (const Mode& mode : {Mode{"station, antenna known to stand", true, false},
                           Mode{"station, motion unknown", true, true},
                           Mode{"station, no range change", false, true}}) {
    station.scene.use_range_change = mode.range_change;
    station.scene.prior.change_is_free = mode.free;
    test::SlipRun clean(station.scene, config);
    const test::SlipCounts none = clean.run();
    const auto slips = test::draw_injections(clean.going(), 0.03, 3, 7);
    const test::SlipCounts found = test::SlipRun(station.scene, config).run(slips);
    test::print_counts(mode.name, found);
    test::print_ends(none);
    test::print_shares(found);
    int shown = 0;
    for (const std::string& note : found.notes) {
      if (++shown < 12) std::cout << "  " << note << '\n';
    }
  }
}

}  // namespace leonav
