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
#include "support/recorded/dataset.h"

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

// The walk's codes of single frequencies, corrected, with the satellites' biases if given.
struct Walk {
  Dataset data = read_walk();
  EphemerisStore ephemeris_store{GnssConfig().ephemeris_store};

  Walk() {
    ephemeris_store.set_klobuchar(data.klobuchar);
    for (const Ephemeris& e : data.ephemerides) ephemeris_store.add(e);
  }

  void gather_pairs(const SignalBiasStore* biases, std::vector<Pair>* pairs) const {
    GnssConfig config = default_gnss_config();
    config.code_combination = CodeCombination::kSingleFrequency;
    PreprocessAids aids;
    aids.signal_biases = biases;
    UbxFileReader reader(shared_data("walk/gnss.ubx"));
    const auto epoch = std::make_unique<MeasurementEpoch>();
    UbxOutput output;
    while (reader.next(&output)) {
      const auto* raw = std::get_if<RawEpoch>(&output);
      if (raw == nullptr) continue;
      preprocess(*raw, ephemeris_store, config, data.truth.front().p_e, epoch.get(), aids);
      for (Pair& pair : *pairs) gather(*epoch, &pair);
    }
  }

  // Medians of the satellites with many epochs, about their common median.
  std::map<SatelliteId, double> scatter(const Pair& pair) const {
    std::map<SatelliteId, double> of_satellite;
    std::vector<double> medians;
    for (const auto& [id, values] : pair.differences_m) {
      if (values.size() < 100) continue;
      of_satellite[id] = quantile(values, 0.5);
      medians.push_back(of_satellite[id]);
    }
    REQUIRE(medians.size() >= 4);
    const double middle = quantile(medians, 0.5);
    for (auto& [id, median] : of_satellite) median -= middle;
    return of_satellite;
  }
};

double rms_of(const std::map<SatelliteId, double>& scatter) {
  std::vector<double> values;
  for (const auto& [id, value] : scatter) values.push_back(value);
  return rms(values);
}

}  // namespace

TEST_CASE("walk: group delays that are not broadcast are within their sigmas") {
  if (!have_shared_data("walk/gnss.ubx")) return;
  const Walk walk;
  std::vector<Pair> pairs = {{System::kBeidou, {'1', 'P'}, {'6', 'I'}},
                             {System::kBeidou, {'5', 'P'}, {'6', 'I'}},
                             {System::kGalileo, {'6', 'B'}, {'1', 'C'}},
                             {System::kGps, {'5', 'Q'}, {'1', 'C'}}};
  walk.gather_pairs(nullptr, &pairs);
  for (const Pair& pair : pairs) {
    const auto scatter = walk.scatter(pair);
    const Ephemeris* e =
        walk.ephemeris_store.ephemeris_at(scatter.begin()->first, walk.data.epochs.front().time);
    REQUIRE(e != nullptr);
    const double sigma = group_delay(*e, pair.untold).sigma_m;
    std::cout << "walk, " << to_string(pair.system) << ' ' << to_string(pair.untold) << " - "
              << to_string(pair.told) << ": " << scatter.size() << " satellites, rms "
              << rms_of(scatter) << " m, sigma of the delay " << sigma << " m\n";
    // 1 m: multipath of both signals and what Klobuchar's model leaves between the bands.
    CHECK(rms_of(scatter) < 1.25 * std::hypot(sigma, 1.0));
  }
}

// The satellites send these delays, in CNAV and B-CNAV: with them the satellites agree better.
TEST_CASE("walk: group delays of CNAV and B-CNAV bring the satellites together") {
  if (!have_shared_data("walk/gnss.ubx")) return;
  const Walk walk;
  SignalBiasStore biases;
  UbxFileReader reader(shared_data("walk/gnss.ubx"));
  for (UbxOutput output; reader.next(&output);) {
    const auto* of_satellite = std::get_if<std::vector<SignalBias>>(&output);
    if (of_satellite == nullptr) continue;
    for (const SignalBias& bias : *of_satellite) REQUIRE(biases.add(bias));
  }
  std::vector<Pair> without = {{System::kBeidou, {'1', 'P'}, {'6', 'I'}},
                               {System::kBeidou, {'5', 'P'}, {'6', 'I'}},
                               {System::kGps, {'5', 'Q'}, {'1', 'C'}}};
  std::vector<Pair> with = without;
  walk.gather_pairs(nullptr, &without);
  walk.gather_pairs(&biases, &with);
  for (std::size_t i = 0; i < with.size(); ++i) {
    const auto before = walk.scatter(without[i]), after = walk.scatter(with[i]);
    std::cout << "walk, " << to_string(with[i].system) << ' ' << to_string(with[i].untold) << " - "
              << to_string(with[i].told) << ": " << after.size() << " satellites, rms "
              << rms_of(before) << " m, with CNAV " << rms_of(after) << " m\n";
    for (const auto& [id, metres] : after)
      std::cout << "  " << to_string(id) << ' ' << before.at(id) << " " << metres << "\n";
    CHECK(rms_of(after) < rms_of(before));
  }
}
