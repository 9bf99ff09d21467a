// How broadcast orbits and clocks stray from precise ones along a station's lines of sight: what a
// carrier's ambiguity takes up with them, and so what its random walk has to be.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <vector>

#include "core/earth/sun_moon.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/measurement/weighting.h"
#include "core/gnss/orbits/precise_orbit.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "drivers/antex/antex_reader.h"
#include "support/catch.h"
#include "support/recorded/dataset.h"

namespace leonav {
namespace {

constexpr double kMask = 0.17453292519943295;  // 10 degrees
constexpr double kNode_s = 900.0;
constexpr double kRandomWalk = 0.005;  // m/sqrt(s): kBroadcastWander of carrier_correction.cc

struct RangeError {
  double error_m = 0.0;     // broadcast range less clock, less the precise one
  std::uint32_t issue = 0;  // of the broadcast elements
};
using SkyErrors = std::map<SatelliteId, RangeError>;  // of one node's time

struct Products {
  test::Dataset data = test::read_station(true);
  std::map<SatelliteId, std::vector<OrbitNode>> orbits;
  AntennaPatternStore antennas;

  Products() {
    for (const PreciseState& s : data.states) {
      auto& nodes = orbits[s.satellite];
      if (std::isnan(s.clock_s) || (!nodes.empty() && s.time <= nodes.back().time)) continue;
      OrbitNode node;
      node.time = s.time;
      node.p_e = s.p_e;
      node.clock_s = s.clock_s;
      nodes.push_back(node);
    }
    const AntexFile file = read_antex(test::shared_data("station/igs14_satellites_and_station.atx"),
                                      {data.epochs[0].time, ""});
    for (const AntennaPattern& pattern : file.satellites) antennas.add(pattern);
  }
};

// Phase centre of the pair that the clocks refer to against the centre of mass; NaN: not known.
double antenna_m(const AntennaPatternStore& antennas, SatelliteId id, const SatelliteState& state,
                 GpsTime time, const Eigen::Vector3d& p_e) {
  const bool galileo = id.system == System::kGalileo;
  const char bands[] = {'1', galileo ? '5' : '2'};
  const IonosphereFree pair =
      ionosphere_free(frequency_hz(id.system, bands[0]), frequency_hz(id.system, bands[1]));
  const Eigen::Matrix3d C_es = satellite_axes(state.p_e, state.v_e, sun_moon_positions(time).sun_e,
                                              AttitudeLaw::kYawSteering);
  double range_m = 0.0;
  for (int i = 0; i < 2; ++i) {
    const AntennaRange range = antennas.satellite_range(id, bands[i], time, state.p_e, C_es, p_e);
    if (range.status == AntennaStatus::kNone) return std::nan("");
    range_m += (i == 0 ? pair.gamma1 : pair.gamma2) * range.range_m;
  }
  return range_m;
}

// At the precise nodes of one day, whose clocks are no interpolation.
std::vector<SkyErrors> straying(const Products& products) {
  const Eigen::Vector3d p_e = test::station_antenna();
  std::vector<Ephemeris> ephemerides = products.data.ephemerides;
  std::stable_sort(ephemerides.begin(), ephemerides.end(),
                   [](const Ephemeris& a, const Ephemeris& b) {
                     return a.transmission_time < b.transmission_time;
                   });
  EphemerisConfig options;
  options.use_precise = false;
  options.galileo_prefers_fnav =
      true;  // whose clocks are of the bands that the precise ones are of
  EphemerisStore ephemeris_store(options);
  std::vector<SkyErrors> skies;
  auto next = ephemerides.begin();
  const GpsTime first = products.data.epochs[0].time;
  for (double t = 0.0; t < 86400.0; t += kNode_s) {
    const GpsTime time = first.plus_seconds(t);
    for (; next != ephemerides.end() && next->transmission_time <= time; ++next)
      ephemeris_store.add(*next);
    SkyErrors& sky = skies.emplace_back();
    for (const auto& [id, nodes] : products.orbits) {
      SatelliteState precise, broadcast;
      if (!precise_state(nodes.data(), nodes.size(), time, 1000.0, id.system, nullptr, &precise) ||
          look_angles(precise.p_e, p_e).elevation < kMask ||
          ephemeris_store.state_at(id, time, &broadcast) != LookupStatus::kOk)
        continue;
      const double error_m = (broadcast.p_e - p_e).norm() - (precise.p_e - p_e).norm() -
                             antenna_m(products.antennas, id, precise, time, p_e) -
                             kSpeedOfLight * (broadcast.clock_s - precise.clock_s);
      if (std::isfinite(error_m)) sky[id] = {error_m, broadcast.issue};
    }
  }
  return skies;
}

struct Growth {
  double squares_m2 = 0.0;
  double freedom = 0.0;
  double rms_m() const { return std::sqrt(squares_m2 / std::max(freedom, 1.0)); }
};

// Of the satellites in view at both times, without what their system's clock takes up. `same`: only
// those whose elements are the same.
Growth growth(const std::vector<SkyErrors>& skies, System system, std::size_t nodes, bool same) {
  Growth growth;
  for (std::size_t k = 0; k + nodes < skies.size(); ++k) {
    std::vector<double> changes;
    for (const auto& [id, before] : skies[k]) {
      const auto after = skies[k + nodes].find(id);
      if (id.system != system || after == skies[k + nodes].end()) continue;
      if (same && after->second.issue != before.issue) continue;
      changes.push_back(after->second.error_m - before.error_m);
    }
    if (changes.size() < 3) continue;
    double mean = 0.0;
    for (const double change : changes) mean += change / static_cast<double>(changes.size());
    for (const double change : changes) growth.squares_m2 += (change - mean) * (change - mean);
    growth.freedom += static_cast<double>(changes.size() - 1);
  }
  return growth;
}

// The same of the errors themselves, not of their changes.
Growth size(const std::vector<SkyErrors>& skies, System system) {
  std::vector<SkyErrors> with_zeros;
  for (const SkyErrors& sky : skies) {
    with_zeros.push_back(sky);
    for (auto& [id, straying] : with_zeros.emplace_back(sky)) straying.error_m = 0.0;
  }
  Growth growth;
  for (std::size_t k = 0; k < with_zeros.size(); k += 2) {
    const Growth one = leonav::growth({with_zeros[k], with_zeros[k + 1]}, system, 1, false);
    growth.squares_m2 += one.squares_m2;
    growth.freedom += one.freedom;
  }
  return growth;
}

}  // namespace

TEST_CASE("Broadcast orbits and clocks wander as an ambiguity's random walk says", "[data]") {
  if (!test::have_shared_data("station/ESBC00DNK_2020177.nav")) return;
  const Products products;
  const std::vector<SkyErrors> skies = straying(products);
  for (const System system : {System::kGps, System::kGalileo}) {
    std::cout << to_string(system) << ", broadcast less precise: " << std::fixed
              << std::setprecision(3) << size(skies, system).rms_m() << " m rms; changes over";
    for (const std::size_t nodes : {1u, 4u, 12u}) {
      const double t = kNode_s * static_cast<double>(nodes);
      const Growth all = growth(skies, system, nodes, false);
      const Growth same = growth(skies, system, nodes, true);
      const double walk_m = kRandomWalk * std::sqrt(t);
      std::cout << "  " << std::lround(t / 60.0) << " min " << all.rms_m() << " m (same elements "
                << same.rms_m() << ", " << static_cast<long>(same.freedom) << " of "
                << static_cast<long>(all.freedom) << "; walk " << walk_m << ')';
      CHECK(all.freedom > 100.0);
      // One walk for all systems: as large as the one that strays most needs, new elements with it.
      CHECK(all.rms_m() < 1.5 * walk_m);
      if (system == System::kGps) CHECK(all.rms_m() > 0.5 * walk_m);
      if (same.freedom > 100.0) CHECK(same.rms_m() < walk_m);
    }
    std::cout << std::defaultfloat << '\n';
  }
}

}  // namespace leonav
