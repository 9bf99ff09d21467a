// What changes under a carrier without its slipping: other elements, antenna patterns, models of
// the ionosphere. Known steps must not hide a slip, and what the arc's constant held of them is
// uncertain afterwards.
#include <cmath>
#include <map>
#include <memory>

#include "carrier_scene.h"
#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "core/gnss/preprocessing/internal/carrier_correction.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "core/gnss/propagation/antenna_patterns.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

constexpr int kChange = 5;  // the epoch of the change

struct Follower {
  CarrierScene scene;
  GnssConfig config = default_gnss_config();
  AntennaPatternStore antennas;
  ReceiverCodeBiases biases;
  CarrierPreprocessor preprocessor{config.cycle_slips};
  MeasurementEpoch epoch;
  KlobucharModel klobuchar;  // the receiver's; the sky has the default one
  SatelliteId slipping;
  double slip_cycles = 0.0;

  Follower() {
    for (SystemConfig& system : config.systems) system.enabled = true;
  }
  // On one frequency nothing but the range change tells of a slip at this interval.
  void use_one_frequency() {
    config.code_combination = CodeCombination::kSingleFrequency;
    scene.receiver.signals = {{{'1', 'C'}, 45.0}};
  }
  void step(int k) {
    scene.sky.ephemeris_store.set_klobuchar({});
    RawEpoch raw = scene.at(kStep_s * k, scene.C_en());
    scene.sky.ephemeris_store.set_klobuchar(klobuchar);
    for (SignalObservation& o : raw.observations)
      if (o.satellite == slipping) o.carrier_cycles += slip_cycles;
    PreprocessAids aids;
    aids.biases = &biases;
    aids.antennas = &antennas;
    aids.carriers = &preprocessor;
    preprocess(raw, scene.sky.ephemeris_store, config, scene.receiver.p_e, &epoch, aids);
    RangeChangePrior stands;
    stands.change_is_free = false;
    preprocessor.check_range_changes(scene.receiver.p_e, stands, &epoch);
    preprocessor.store_epoch(epoch, scene.receiver.p_e);
  }
  void run_to_change() {
    for (int k = 0; k < kChange; ++k) step(k);
    REQUIRE(epoch.satellites.size() > 12);
  }
  // By one cycle from the next step on.
  void slip_a_high_satellite() {
    for (const SatelliteInView& view : epoch.satellites)
      if (view.arc != 0 && view.elevation > 0.8) slipping = view.satellite;
    slip_cycles = 1.0;
  }
  // New elements for every satellite, another metre or so off: what they are off by is not the
  // satellites' doing.
  void change_elements() {
    int n = 0;
    for (Ephemeris e : scene.sky.ephemerides) {
      e.issue = static_cast<std::uint16_t>(e.issue + 1);
      e.transmission_time = e.transmission_time.plus_seconds(60.0);
      e.af0 += 3e-9 * std::sin(1.3 * ++n);
      e.m0 += 4e-8 * std::cos(2.1 * n);
      REQUIRE(scene.sky.ephemeris_store.add(e));
    }
  }
};

}  // namespace

TEST_CASE("a slip where the broadcast elements change is found, and nothing else is ended",
          "[cycle_slip]") {
  const auto f = std::make_unique<Follower>();
  f->use_one_frequency();
  f->run_to_change();
  f->change_elements();
  f->slip_a_high_satellite();
  f->step(kChange);
  int going = 0;
  double largest = 0.0;
  for (const SatelliteInView& view : f->epoch.satellites) {
    if (view.arc == 0 || view.elevation < 0.3) continue;
    CAPTURE(to_string(view.satellite), view.orbit_step_m);
    largest = std::max(largest, std::abs(view.orbit_step_m));
    CHECK(view.arc_started == (view.satellite == f->slipping));
    if (view.satellite == f->slipping) CHECK(view.arc_causes == SlipCause::kRangeChange);
    going += view.arc_started ? 0 : 1;
  }
  CHECK(going > 8);
  CHECK(largest > 0.5);  // beyond any cycle
}

TEST_CASE("a slip where other coefficients of the ionosphere come is found, and no other arc ends",
          "[cycle_slip]") {
  const bool one = GENERATE(true, false);
  const auto f = std::make_unique<Follower>();
  if (one) f->use_one_frequency();
  f->run_to_change();
  f->klobuchar = {.alpha = {6e-8, 0, 0, 0}, .beta = {2.6e5, 0, 0, 0}, .valid = true};
  if (one) f->slip_a_high_satellite();
  f->step(kChange);
  int going = 0;
  double largest = 0.0;
  for (const Measurement& m : f->epoch.measurements) {
    if (m.observable != Observable::kCarrier) continue;
    const SatelliteInView& view = f->epoch.satellites[m.satellite_index];
    CAPTURE(one, to_string(view.satellite), view.elevation, m.disturbance_m);
    CHECK(view.arc_started == (one && view.satellite == f->slipping));
    if (view.arc_started) continue;
    largest = std::max(largest, m.disturbance_m);
    ++going;
  }
  CHECK(going > 8);
  if (one) {
    CHECK(largest > 1.0);  // far beyond any cycle
  } else {
    CHECK(largest == 0.0);
  }
}

TEST_CASE("an arc of one frequency that nothing tests ends; a pair's does not", "[cycle_slip]") {
  for (const bool one : {true, false}) {
    CAPTURE(one);
    const auto f = std::make_unique<Follower>();
    if (one) f->use_one_frequency();
    f->run_to_change();
    f->preprocessor.reset_position();  // what the range change compares with
    f->step(kChange);
    int arcs = 0;
    for (const SatelliteInView& view : f->epoch.satellites) {
      if (view.arc == 0) continue;
      ++arcs;
      CHECK(view.arc_started == one);
      if (one) CHECK(view.arc_causes == SlipCause::kUntested);
    }
    CHECK(arcs > 8);
    f->step(kChange + 1);  // and goes on
    for (const SatelliteInView& view : f->epoch.satellites) CHECK_FALSE(view.arc_started);
  }
}

TEST_CASE("a receiver antenna that becomes known disturbs every arc and the position, once") {
  const auto f = std::make_unique<Follower>();
  f->run_to_change();
  CHECK(f->epoch.position_disturbance_m == 0.0);
  std::map<SatelliteId, std::uint32_t> arcs;
  for (const SatelliteInView& view : f->epoch.satellites) arcs[view.satellite] = view.arc;
  const AntennaPattern l1 = receiver_pattern(System::kGps, '1', {0, 0, 90});
  const AntennaPattern l2 = receiver_pattern(System::kGps, '2', {0, 0, 90});
  REQUIRE(f->antennas.add(l1));
  REQUIRE(f->antennas.add(l2));
  f->step(kChange);
  int disturbed = 0;
  for (const Measurement& m : f->epoch.measurements) {
    if (m.observable != Observable::kCarrier) continue;
    const SatelliteInView& view = f->epoch.satellites[m.satellite_index];
    CAPTURE(to_string(view.satellite), view.elevation);
    CHECK(view.arc == arcs[view.satellite]);
    // 9 cm upwards on both frequencies are 9 cm in their combination.
    CHECK(m.disturbance_m == Approx(0.09 * std::sin(view.elevation)).margin(2e-4));
    ++disturbed;
  }
  CHECK(disturbed > 8);
  CHECK(f->epoch.position_disturbance_m > 0.01);
  CHECK(f->epoch.position_disturbance_m < 0.18);
  // The same patterns once more, as their sender repeats them, are no change.
  REQUIRE(f->antennas.add(l1));
  f->step(kChange + 1);
  CHECK(f->epoch.position_disturbance_m == 0.0);
  for (const Measurement& m : f->epoch.measurements) CHECK(m.disturbance_m == 0.0);
}

TEST_CASE("a satellite's antenna that becomes known disturbs its own arc, which wandered before") {
  const auto f = std::make_unique<Follower>();
  for (const Ephemeris& e : f->scene.sky.ephemerides)
    for (int i = -10; i <= 10; ++i)
      REQUIRE(f->scene.sky.ephemeris_store.add(product_node(e, kSkyEpoch.plus_seconds(900.0 * i))));
  f->run_to_change();
  const SatelliteId known = f->epoch.satellites[f->epoch.measurements[0].satellite_index].satellite;
  const auto carrier_of = [&](SatelliteId id) {
    for (const Measurement& m : f->epoch.measurements)
      if (m.observable == Observable::kCarrier &&
          f->epoch.satellites[m.satellite_index].satellite == id)
        return m;
    FAIL("no carrier");
    return Measurement();
  };
  const double unknown_random_walk = carrier_of(known).random_walk;
  for (const char band : {'1', '2', '5'})
    REQUIRE(f->antennas.add(satellite_pattern(known, band, {0, 0, 1500})));
  f->step(kChange);
  for (const SatelliteInView& view : f->epoch.satellites) {
    if (view.arc == 0) continue;
    const Measurement m = carrier_of(view.satellite);
    CHECK_FALSE(view.arc_started);
    if (view.satellite == known) {
      CHECK(m.disturbance_m == Approx(1.5).margin(0.06));  // times the cosine of the nadir angle
      CHECK(m.random_walk < 0.5 * unknown_random_walk);
    } else {
      CHECK(m.disturbance_m == 0.0);
      CHECK(m.random_walk == unknown_random_walk);
    }
  }
  CHECK(f->epoch.position_disturbance_m > 0.3);
  CHECK(f->epoch.position_disturbance_m < 1.5);
}

TEST_CASE("how far a carrier may change unseen: nanoseconds' clocks, one frequency's ionosphere") {
  const CycleSlipConfig config;
  const BandPlan bands;
  const Eigen::Vector3d p_a_e = Eigen::Vector3d::Zero();
  SatelliteInView view;
  view.elevation = 1.5;
  view.source = OrbitSource::kPrecise;
  Measurement carrier;
  carrier.code = {'1', 'C'};
  CHECK(change_sigma_m(config, bands, view, carrier, p_a_e, 30.0) == Approx(0.015).epsilon(0.01));
  view.source = OrbitSource::kBroadcast;
  carrier.second_code = {'2', 'W'};
  CHECK(change_sigma_m(config, bands, view, carrier, p_a_e, 30.0) == Approx(0.0082).epsilon(0.01));
  carrier.second_code = {};
  // A cycle of 19 cm is twice the limit of five sigma, noise of 3 mm at both epochs included.
  CHECK(5.0 * std::hypot(change_sigma_m(config, bands, view, carrier, p_a_e, 30.0), 0.0042) <
        0.095);
}

TEST_CASE("the line of sight to a low satellite turns over the error of its broadcast orbit") {
  const CycleSlipConfig config;
  BandPlan bands;
  bands.set_leo('9', 2492.028e6);
  const Eigen::Vector3d p_a_e(6378137.0, 0.0, 0.0);
  SatelliteInView view;
  view.satellite = {System::kLeo, 7};
  view.elevation = 1.5;
  view.source = OrbitSource::kBroadcast;
  view.orbit_sigma_m = 0.5;
  view.p_e = {6378137.0 + 750e3, 0.0, 0.0};
  view.v_e = {0.0, 7500.0, 0.0};  // turns by 0.01 rad/s
  Measurement carrier;
  carrier.code = {'9', 'S'};
  carrier.second_code = {'1', 'C'};
  const double clock = change_sigma_m(config, bands, view, carrier, view.p_e * 1e3, 30.0);
  const double both = change_sigma_m(config, bands, view, carrier, p_a_e, 30.0);
  CHECK(std::sqrt(both * both - clock * clock) == Approx(0.5 * 0.01 * 30.0).epsilon(0.001));
  carrier.second_code = {};
  // One frequency: the ionosphere of S band is (1575.42/2492.028)^2 of that of L1.
  const double s_band = change_sigma_m(config, bands, view, carrier, view.p_e * 1e3, 30.0);
  carrier.code = {'1', 'C'};
  const double l_band = change_sigma_m(config, bands, view, carrier, view.p_e * 1e3, 30.0);
  CHECK(std::sqrt((s_band * s_band - clock * clock) / (l_band * l_band - clock * clock)) ==
        Approx(std::pow(1575.42 / 2492.028, 2)).epsilon(0.001));
}

TEST_CASE("the pair that is followed is forgotten when its arc's gap ends, not by this interval") {
  CarrierPreprocessor preprocessor{CycleSlipConfig()};
  const GpsTime start = GpsTime::from_week_and_tow(2200, 1000.0);
  SignalObservation l1, l2;
  l1.satellite = l2.satellite = {System::kGps, 7};
  l1.code = {'1', 'C'};
  l2.code = {'2', 'W'};
  l1.pseudorange_m = l2.pseudorange_m = 2.2e7;
  l1.carrier_cycles = l2.carrier_cycles = 1e8;
  double t = 0.0;
  const auto epoch = [&](double dt) {
    t += dt;
    preprocessor.begin(start.plus_seconds(t));
    preprocessor.set_wind_up(l1.satellite, 0.0);
    return preprocessor.tracked_pair(l1.satellite) != nullptr;
  };
  const auto see = [&] {
    preprocessor.add_carrier({&l1, &l2}, 1.0);
    preprocessor.update_arcs();
  };
  epoch(0.0);
  see();
  for (int i = 0; i < 5; ++i) {
    CHECK(epoch(1.0));
    see();
  }
  CHECK(epoch(9.0));
  see();
  // 20 s is beyond the 10 s that an arc at 1 Hz survives, though within 2.5 times itself.
  CHECK_FALSE(epoch(20.0));
}

}  // namespace leonav::test
