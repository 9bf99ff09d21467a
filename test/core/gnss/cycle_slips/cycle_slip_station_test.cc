// The detectors on six hours of a geodetic receiver, 30 s, into whose carriers slips are put.
#include "support/catch.h"
#include "support/recorded/dataset.h"
#include "support/slips/slip_table.h"

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
  test::Feed feed(station.data, EphemerisConfig{});
  const Eigen::Vector3d antenna = test::station_antenna();
  for (const RawEpoch& raw : station.data.epochs) {
    auto& of_epoch = station.predictions.emplace_back();
    const EphemerisStore& ephemeris_store = feed.at(raw.time);
    for (const SignalObservation& o : raw.observations) {
      if (of_epoch.count(o.satellite) > 0) continue;
      const auto prediction = test::predict_by_catalog(ephemeris_store, o.satellite, raw.time,
                                                       o.pseudorange_m, antenna);
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
  constexpr double kShare = 0.06;  // of the satellite-epochs slip
  struct Mode {
    const char* name;
    bool range_change, free, pairs;
    bool CycleSlipConfig::*off;
  };
  std::cout << "Station, 30 s, GPS, Galileo and BeiDou\n";
  test::print_heading();
  for (const Mode& mode :
       {Mode{"antenna known to stand", true, false, true, nullptr},
        Mode{"motion unknown", true, true, true, nullptr},
        Mode{"  without geometry-free", true, true, true, &CycleSlipConfig::use_geometry_free},
        Mode{"  without Melbourne-Wuebbena", true, true, true,
             &CycleSlipConfig::use_melbourne_wuebbena},
        Mode{"  first frequency alone, antenna stands", true, false, false, nullptr},
        Mode{"no range change", false, true, true, nullptr},
        Mode{"  geometry-free alone", false, true, true, &CycleSlipConfig::use_melbourne_wuebbena},
        Mode{"  Melbourne-Wuebbena alone", false, true, true,
             &CycleSlipConfig::use_geometry_free}}) {
    station.scene.use_range_change = mode.range_change;
    station.scene.prior.change_is_free = mode.free;
    station.scene.second_signals = mode.pairs;
    CycleSlipConfig config;
    if (mode.off != nullptr) config.*mode.off = false;
    test::SlipCounts none;
    const test::SlipCounts found =
        test::run_with_slips(station.scene, config, kShare, false, &none);
    test::print_counts(mode.name, found);
    if (mode.off != nullptr) continue;
    test::print_ends(none);
    test::print_shares(found);
    for (std::size_t i = 0; i < std::min<std::size_t>(8, found.notes.size()); ++i) {
      std::cout << "    " << found.notes[i] << '\n';
    }
    CHECK(found.injected > 500);
    if (!mode.pairs) continue;  // ionosphere and satellite clocks of 30 s: printed, not promised
    CHECK(found.pairs_detected() >= 0.995);
    CHECK(none.false_rate() <= 0.001);
    CHECK(found.false_rate() <= 0.001);
    if (mode.range_change) CHECK(found.detected() >= 0.995);
  }
}

}  // namespace leonav
