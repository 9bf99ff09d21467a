// Caps and capacities of the preprocessing, and what an epoch of 40 satellites costs.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>

#include "core/gnss/positioning/point_solution.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"
#include "tools/common/allocations/allocation_counter.h"

using namespace leonav;
using namespace leonav::test;

namespace {

// Every satellite that has a name: some hundred of them above the horizon.
SimulatedSky crowded_sky() {
  return sky_of({{System::kGps, 9, 7, 26'560e3, 0.96, 0.008},
                 {System::kGalileo, 5, 10, 29'600e3, 0.977, 0.0005},
                 {System::kBeidou, 5, 8, 27'906e3, 0.96, 0.001},
                 {System::kLeo, 19, 21, 8'400e3, 0.96, 0.001}});
}

std::map<SatelliteId, Reason> reasons_of(const MeasurementEpoch& epoch) {
  std::map<SatelliteId, Reason> reasons;
  for (const SatelliteInView& view : epoch.satellites) reasons[view.satellite] = view.reason;
  return reasons;
}

}  // namespace

TEST_CASE("a cap keeps the highest satellites of its system and touches no other") {
  const SimulatedReceiver receiver;
  const SimulatedSky sky = sky_of({gps_walker(), galileo_walker()});
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  const auto free = std::make_unique<MeasurementEpoch>(),
             capped = std::make_unique<MeasurementEpoch>();
  GnssConfig config = default_gnss_config();
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, free.get());
  for (int cap = 1; cap <= 4; ++cap) {
    config.systems[index_of(System::kGps)].max_satellites = cap;
    preprocess(raw, sky.ephemeris_store, config, receiver.p_e, capped.get());
    const auto reasons = reasons_of(*capped);
    int kept = 0;
    double lowest_kept = 10.0, highest_left = -10.0;
    for (const SatelliteInView& view : free->satellites) {
      const Reason reason = reasons.at(view.satellite);
      if (view.satellite.system != System::kGps || view.reason != Reason::kUsed) {
        CHECK(reason == view.reason);
      } else if (reason == Reason::kUsed) {
        ++kept;
        lowest_kept = std::min(lowest_kept, view.elevation);
      } else {
        CHECK(reason == Reason::kSatelliteCap);
        highest_left = std::max(highest_left, view.elevation);
      }
    }
    CAPTURE(cap);
    CHECK(kept == cap);
    CHECK(lowest_kept > highest_left);
    for (const Measurement& m : capped->measurements) {
      CHECK(capped->satellites[m.satellite_index].reason == Reason::kUsed);
    }
  }
}

TEST_CASE(
    "a point solution takes no notice of caps: with fewer than four there would be no start") {
  const SimulatedReceiver receiver;
  const SimulatedSky sky = sky_of({gps_walker()});
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  const auto epoch = std::make_unique<MeasurementEpoch>();
  GnssConfig config = default_gnss_config();
  config.systems[index_of(System::kGps)].max_satellites = 1;
  const PointSolution point = solve_point(raw, sky.ephemeris_store, config, RobustConfig{},
                                          Eigen::Vector3d::Zero(), epoch.get());
  CHECK(point.status == PointStatus::kOk);
  CHECK((point.p_e - receiver.p_e).norm() < 10.0);
}

TEST_CASE("a faulty satellite is neither measured nor solved with, and takes no place of a cap") {
  const SimulatedReceiver receiver;
  const SimulatedSky sky = sky_of({gps_walker()});
  const auto epoch = std::make_unique<MeasurementEpoch>();
  GnssConfig config = default_gnss_config();
  preprocess(simulate_epoch(sky, receiver, 0.0), sky.ephemeris_store, config, receiver.p_e,
             epoch.get());
  const SatelliteId faulty =
      std::max_element(epoch->satellites.begin(), epoch->satellites.end(),
                       [](const auto& a, const auto& b) { return a.elevation < b.elevation; })
          ->satellite;
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0, [&](SignalObservation* o) {
    if (o->satellite == faulty) o->pseudorange_m += 25.0;
  });
  const std::array excluded = {faulty};
  RobustConfig robust;
  robust.enabled = false;  // nothing else may leave it out
  const PointSolution point = solve_point(raw, sky.ephemeris_store, config, robust,
                                          Eigen::Vector3d::Zero(), epoch.get(), nullptr, excluded);
  REQUIRE(point.status == PointStatus::kOk);
  CHECK((point.p_e - receiver.p_e).norm() < 0.1);
  CHECK(reasons_of(*epoch).at(faulty) == Reason::kFaulty);
  const int cap = config.systems[index_of(System::kGps)].max_satellites = 4;
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get(), {.faulty = excluded});
  const auto reasons = reasons_of(*epoch);
  CHECK(reasons.at(faulty) == Reason::kFaulty);
  CHECK(std::count_if(reasons.begin(), reasons.end(),
                      [](const auto& entry) { return entry.second == Reason::kUsed; }) == cap);
}

TEST_CASE("more than a hundred satellites in one epoch are solved") {
  SimulatedReceiver receiver;
  receiver.elevation_mask = 0.02;
  receiver.signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}};
  const SimulatedSky sky = crowded_sky();
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  GnssConfig config = default_gnss_config();
  config.elevation_mask = 0.02;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  const PointSolution point = solve_point(raw, sky.ephemeris_store, config, RobustConfig{},
                                          Eigen::Vector3d::Zero(), epoch.get());
  std::printf("%zu satellites in one epoch, %d used\n", epoch->satellites.size(), point.satellites);
  CHECK(epoch->satellites.size() >= 100);
  CHECK(point.satellites >= 100);
  REQUIRE(point.status == PointStatus::kOk);
  CHECK((point.p_e - receiver.p_e).norm() < 0.1);
}

TEST_CASE("of two hundred satellites, most of them LEO, every one has its place and its reason") {
  SimulatedReceiver receiver;
  receiver.elevation_mask = -0.43;  // as from high above: the rest is below the mask of use
  const SimulatedSky sky = sky_of({{System::kGps, 9, 7, 26'560e3, 0.96, 0.008},
                                   {System::kGalileo, 5, 10, 29'600e3, 0.977, 0.0005},
                                   {System::kLeo, 19, 21, 9'950e3, 0.96, 0.001}});
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  std::size_t leo = 0, satellites = 0;
  for (std::size_t i = 0; i < raw.observations.size(); ++i) {
    const SatelliteId id = raw.observations[i].satellite;
    if (i > 0 && raw.observations[i - 1].satellite == id) continue;
    ++satellites;
    leo += id.system == System::kLeo ? 1 : 0;
  }
  REQUIRE(leo >= 150);
  REQUIRE(satellites >= leo + 40);
  GnssConfig config = default_gnss_config();
  config.elevation_mask = 0.02;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get());
  CHECK(epoch->satellites.size() == satellites);
  std::size_t used = 0;
  for (const SatelliteInView& view : epoch->satellites) {
    CHECK(view.reason == (view.elevation < 0.02 ? Reason::kLowElevation : Reason::kUsed));
    used += view.reason == Reason::kUsed ? 1 : 0;
  }
  std::printf("%zu satellites, %zu of them LEO: %zu used\n", satellites, leo, used);
  CHECK(used >= 100);
  CHECK(epoch->measurements.size() == 2 * used);
}

TEST_CASE("every signal of an epoch from a satellite of its own: all are listed") {
  RawEpoch raw;
  raw.time = kSkyEpoch;
  for (const auto& [system, count] :
       {std::pair(System::kGps, 63), {System::kGalileo, 50}, {System::kLeo, 399}}) {
    for (int number = 1; number <= count; ++number) {
      SignalObservation o;
      o.satellite = {system, static_cast<std::uint16_t>(number)};
      o.code = {'1', 'C'};
      o.pseudorange_m = 2.2e7;
      o.cn0_dbhz = 45.0;
      raw.observations.push_back(o);
    }
  }
  REQUIRE(raw.observations.size() == kMaxObservations);
  const auto epoch = std::make_unique<MeasurementEpoch>();
  preprocess(raw, EphemerisStore(EphemerisConfig{}), default_gnss_config(), Eigen::Vector3d::Zero(),
             epoch.get());
  CHECK(epoch->satellites.size() == kMaxObservations);
  for (const SatelliteInView& view : epoch->satellites) CHECK(view.reason != Reason::kUsed);
}

TEST_CASE("what does not fit into the table of measurements says so") {
  SimulatedReceiver receiver;
  receiver.elevation_mask = 0.003;
  const SimulatedSky sky = sky_of({{System::kGps, 9, 7, 26'560e3, 0.96, 0.008},
                                   {System::kGalileo, 5, 10, 29'600e3, 0.977, 0.0005},
                                   {System::kBeidou, 5, 9, 27'906e3, 0.96, 0.001},
                                   {System::kLeo, 19, 21, 9'950e3, 0.96, 0.001}});
  // Up to six bands each: more codes and Dopplers than the table of measurements holds.
  receiver.signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}, {{'5', 'Q'}, 42.0},
                      {{'7', 'Q'}, 42.0}, {{'6', 'B'}, 42.0}, {{'8', 'Q'}, 42.0}};
  RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  GnssConfig config = default_gnss_config();
  config.elevation_mask = 0.003;
  config.code_combination = CodeCombination::kSingleFrequency;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  preprocess(raw, sky.ephemeris_store, config, receiver.p_e, epoch.get());
  std::size_t full = 0;
  double lowest_used = 10.0, highest_full = -10.0;
  for (const SatelliteInView& view : epoch->satellites) {
    full += view.reason == Reason::kCapacity ? 1 : 0;
    if (view.reason == Reason::kCapacity) highest_full = std::max(highest_full, view.elevation);
    if (view.reason == Reason::kUsed) lowest_used = std::min(lowest_used, view.elevation);
  }
  std::printf("%zu observations, %zu measurements, %zu satellites without room\n",
              raw.observations.size(), epoch->measurements.size(), full);
  CHECK(epoch->measurements.size() >= kMaxMeasurements - 6);
  CHECK(full > 0);
  CHECK(lowest_used > highest_full);
}

TEST_CASE("preprocessing and point solution allocate nothing, faults or none") {
  const SimulatedReceiver receiver;
  const SimulatedSky sky = sky_of({gps_walker(), galileo_walker(), leo_walker()});
  RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  const GnssConfig config = default_gnss_config();
  const auto epoch = std::make_unique<MeasurementEpoch>();
  PointSolution point;
  start_counting_allocations();
  point = solve_point(raw, sky.ephemeris_store, config, RobustConfig{}, Eigen::Vector3d::Zero(),
                      epoch.get());
  CHECK(stop_counting_allocations() == 0);
  CHECK(point.status == PointStatus::kOk);
  for (std::size_t i = 0; i < 6; ++i) raw.observations[i].pseudorange_m += 60.0;
  start_counting_allocations();
  point = solve_point(raw, sky.ephemeris_store, config, RobustConfig{}, receiver.p_e, epoch.get());
  CHECK(stop_counting_allocations() == 0);
  CHECK(point.status == PointStatus::kOk);
}

TEST_CASE("microseconds for an epoch of about 40 satellites", "[.bench]") {
  const SimulatedReceiver receiver;
  const SimulatedSky sky = sky_of({gps_walker(),
                                   galileo_walker(),
                                   leo_walker(),
                                   {System::kBeidou, 3, 8, 27'906e3, 0.96, 0.001}});
  const RawEpoch clean = simulate_epoch(sky, receiver, 0.0);
  RawEpoch faulty = clean;
  for (std::size_t i = 0; i < 6; ++i) faulty.observations[i].pseudorange_m += 60.0;
  const auto epoch = std::make_unique<MeasurementEpoch>();
  const auto microseconds = [](auto run) {
    constexpr int kRuns = 300;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRuns; ++i) run();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
               .count() /
           kRuns;
  };
  const GnssConfig config = default_gnss_config();
  const auto solve = [&](const RawEpoch& raw) {
    solve_point(raw, sky.ephemeris_store, config, RobustConfig{}, receiver.p_e, epoch.get());
  };
  const double prepared = microseconds(
      [&] { preprocess(clean, sky.ephemeris_store, config, receiver.p_e, epoch.get()); });
  const double solved = microseconds([&] { solve(clean); });
  const double searched = microseconds([&] { solve(faulty); });
  std::printf(
      "%zu satellites: preprocess %.0f us, with solution %.0f us, with three faults %.0f us\n",
      epoch->satellites.size(), prepared, solved, searched);
}
