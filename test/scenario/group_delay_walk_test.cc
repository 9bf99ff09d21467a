// Signals whose group delay the navigation messages do not tell (B1C, B2a, E6, GPS L5), beside one
// whose delay they do, on the walk: what is left after every correction is within what the group
// delay's sigma says. BeiDou's TGD1 spans 19 m there, so that a delay left out would show.
#include <iostream>
#include <map>
#include <memory>

#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/propagation/group_delay.h"
#include "drivers/ubx/ubx_file_reader.h"
#include "support/catch.h"
#include "support/dataset.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Pair {
  System system;
  SignalCode untold, told;
  std::map<SatelliteId, std::vector<double>> differences_m = {};  // of corrected ranges
};

void gather(const MeasurementEpoch& epoch, Pair* pair) {
  std::map<SatelliteId, double> told;
  for (const bool second_pass : {false, true}) {
    for (const Measurement& m : epoch.measurements) {
      const SatelliteId id = epoch.satellites[m.satellite_index].satellite;
      if (m.observable != Observable::kCode || id.system != pair->system) continue;
      if (!second_pass && m.code == pair->told) told[id] = m.value;
      if (second_pass && m.code == pair->untold && told.count(id) > 0) {
        pair->differences_m[id].push_back(m.value - told[id]);
      }
    }
  }
}

}  // namespace

TEST_CASE("walk: group delays that are not broadcast are within their sigmas") {
  if (!have_shared_data("walk/gnss.ubx")) return;
  const Dataset walk = read_walk();
  GnssConfig config = default_gnss_config();
  config.code_combination = CodeCombination::kSingleFrequency;
  EphemerisStore ephemeris_store(config.ephemeris_store);
  ephemeris_store.set_klobuchar(walk.klobuchar);
  for (const Ephemeris& e : walk.ephemerides) ephemeris_store.add(e);
  std::vector<Pair> pairs = {{System::kBeidou, {'1', 'P'}, {'6', 'I'}},
                             {System::kBeidou, {'5', 'P'}, {'6', 'I'}},
                             {System::kGalileo, {'6', 'B'}, {'1', 'C'}},
                             {System::kGps, {'5', 'Q'}, {'1', 'C'}}};
  UbxFileReader reader(shared_data("walk/gnss.ubx"));
  const auto epoch = std::make_unique<MeasurementEpoch>();
  UbxOutput output;
  while (reader.next(&output)) {
    const auto* raw = std::get_if<RawEpoch>(&output);
    if (raw == nullptr) continue;
    preprocess(*raw, ephemeris_store, config, walk.truth.front().p_e, epoch.get());
    for (Pair& pair : pairs) gather(*epoch, &pair);
  }
  for (const Pair& pair : pairs) {
    std::vector<double> medians;
    double sigma = 0.0;
    for (const auto& [id, values] : pair.differences_m) {
      if (values.size() < 100) continue;
      medians.push_back(quantile(values, 0.5));
      const Ephemeris* e = ephemeris_store.ephemeris_at(id, walk.epochs.front().time);
      REQUIRE(e != nullptr);
      sigma = group_delay(*e, pair.untold).sigma_m;
    }
    REQUIRE(medians.size() >= 4);
    const double middle = quantile(medians, 0.5);
    for (double& m : medians) m -= middle;
    std::cout << "walk, " << to_string(pair.system) << ' ' << to_string(pair.untold) << " - "
              << to_string(pair.told) << ": " << medians.size() << " satellites, rms "
              << rms(medians) << " m, sigma of the delay " << sigma << " m\n";
    // 1 m: multipath of both signals and what Klobuchar's model leaves between the bands.
    CHECK(rms(medians) < 1.25 * std::hypot(sigma, 1.0));
  }
}
