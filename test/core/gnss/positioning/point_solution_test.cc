#include "core/gnss/positioning/point_solution.h"

#include <Eigen/Core>
#include <iostream>
#include <memory>
#include <random>

#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "support/sky/simulated_sky.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Solved {
  PointSolution point;
  std::unique_ptr<MeasurementEpoch> epoch = std::make_unique<MeasurementEpoch>();
};

Solved solve(const SimulatedSky& sky, const RawEpoch& raw,
             const Eigen::Vector3d& start = Eigen::Vector3d::Zero(),
             const GnssConfig& config = default_gnss_config()) {
  Solved solved;
  solved.point =
      solve_point(raw, sky.ephemeris_store, config, RobustConfig{}, start, solved.epoch.get());
  return solved;
}

SimulatedReceiver moving_receiver() {
  SimulatedReceiver receiver;
  // Level: the delay models know nothing of a climb, which changes the troposphere's delay.
  receiver.v_e = rotation_ecef_to_ned(to_geodetic(receiver.p_e)).transpose() *
                 Eigen::Vector3d(30.0, -40.0, 0.0);
  receiver.clock_s = 3.217e-3;
  receiver.clock_drift = 4.0e-8;
  return receiver;
}

Reason satellite_reason(const MeasurementEpoch& epoch, SatelliteId id) {
  for (const SatelliteInView& view : epoch.satellites) {
    if (view.satellite == id) return view.reason;
  }
  FAIL("satellite is not listed");
  return Reason::kUsed;
}

}  // namespace

TEST_CASE("point solution recovers position, velocity and clocks from exact measurements") {
  const SimulatedReceiver receiver = moving_receiver();
  for (const SimulatedSky& sky : {sky_of({gps_walker()}), sky_of({leo_walker()}),
                                  sky_of({gps_walker(), galileo_walker(), leo_walker()})}) {
    const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
    for (const Eigen::Vector3d& start :
         {Eigen::Vector3d(0, 0, 0), receiver.p_e, to_ecef({-0.4, 2.1, 0.0}),
          to_ecef({0.5, 0.14, 0.0}), Eigen::Vector3d(1e9, 0, 0)}) {
      const Solved solved = solve(sky, raw, start);
      CAPTURE(start.transpose(), raw.observations.size());
      REQUIRE(solved.point.status == PointStatus::kOk);
      CHECK((solved.point.p_e - receiver.p_e).norm() < 0.02);
      REQUIRE(solved.point.has_velocity);
      CHECK((solved.point.v_e - receiver.v_e).norm() < 0.005);
      const std::size_t base = index_of(raw.observations.front().satellite.system);
      CHECK(solved.point.clock_m[base] == Approx(receiver.clock_s * kSpeedOfLight).margin(0.02));
      CHECK(solved.point.clock_drift_m_s[base] ==
            Approx(receiver.clock_drift * kSpeedOfLight).margin(0.005));
      CHECK(std::isnan(solved.point.clock_m[index_of(System::kBeidou)]));
    }
  }
}

TEST_CASE("each system has its own clock") {
  SimulatedReceiver receiver = moving_receiver();
  receiver.system_offset_m = {0.0, 37.0, 0.0, -250.0};
  const SimulatedSky sky = sky_of({gps_walker(), galileo_walker(), leo_walker()});
  const Solved solved = solve(sky, simulate_epoch(sky, receiver, 0.0));
  REQUIRE(solved.point.status == PointStatus::kOk);
  CHECK((solved.point.p_e - receiver.p_e).norm() < 0.02);
  CHECK(solved.point.clock_m[1] - solved.point.clock_m[0] == Approx(37.0).margin(0.05));
  CHECK(solved.point.clock_m[3] - solved.point.clock_m[0] == Approx(-250.0).margin(0.05));
}

TEST_CASE("a band that the receiver delays by kilometres does no harm") {
  SimulatedReceiver receiver = moving_receiver();
  receiver.signals = {{{'1', 'C'}, 45.0}, {{'5', 'X'}, 45.0}};
  const SimulatedSky sky = sky_of({gps_walker()});
  const RawEpoch raw = simulate_epoch(sky, receiver, 0.0, [](SignalObservation* o) {
    if (o->code.band == '5') o->pseudorange_m -= 2358.0;
    // Half of the satellites are too old to send L5.
    if (o->code.band == '5' && o->satellite.number % 2 == 0) o->pseudorange_m = kNotMeasured;
  });
  GnssConfig config = default_gnss_config();
  for (const CodeCombination combination :
       {CodeCombination::kSingleFrequency, CodeCombination::kIonosphereFree}) {
    config.code_combination = combination;
    const Solved solved = solve(sky, raw, Eigen::Vector3d::Zero(), config);
    REQUIRE(solved.point.status == PointStatus::kOk);
    CHECK((solved.point.p_e - receiver.p_e).norm() < 0.1);
  }
}

TEST_CASE("a lonely satellite of a system moves nothing and is not called used") {
  const SimulatedReceiver receiver = moving_receiver();
  const SimulatedSky sky = sky_of({gps_walker(), galileo_walker()});
  RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
  SatelliteId kept;
  RawEpoch thinned;
  thinned.time = raw.time;
  for (SignalObservation& o : raw.observations) {
    if (o.satellite.system == System::kGalileo) {
      const SatelliteInView* high = nullptr;
      const Solved all = solve(sky, raw);
      for (const SatelliteInView& view : all.epoch->satellites) {
        if (view.satellite.system != System::kGalileo) continue;
        if (high == nullptr || view.elevation > high->elevation) high = &view;
      }
      kept = high->satellite;
      break;
    }
  }
  for (SignalObservation& o : raw.observations) {
    if (o.satellite.system == System::kGalileo && o.satellite != kept) continue;
    if (o.satellite == kept) o.pseudorange_m += 5000.0;
    thinned.observations.push_back(o);
  }
  const Solved solved = solve(sky, thinned);
  REQUIRE(solved.point.status == PointStatus::kOk);
  CHECK((solved.point.p_e - receiver.p_e).norm() < 0.02);
  CHECK(satellite_reason(*solved.epoch, kept) == Reason::kNotSolved);
  CHECK(std::isnan(solved.point.clock_m[index_of(System::kGalileo)]));
}

TEST_CASE("too few satellites, nothing, and nonsense give a status and no position") {
  const SimulatedSky sky = sky_of({gps_walker()});
  RawEpoch raw = simulate_epoch(sky, SimulatedReceiver{}, 0.0);
  RawEpoch empty;
  empty.time = raw.time;
  CHECK(solve(sky, empty).point.status == PointStatus::kTooFewSatellites);
  CHECK(solve(sky, RawEpoch{}).point.status == PointStatus::kTooFewSatellites);
  RawEpoch few = raw;
  few.observations.resize(6);  // three satellites
  const Solved three = solve(sky, few);
  CHECK(three.point.status == PointStatus::kTooFewSatellites);
  CHECK(three.epoch->satellites.size() == 3);
  for (const Measurement& m : three.epoch->measurements) CHECK(m.reason == Reason::kNotSolved);
  for (const double value : {0.0, -1.0, 1e300, std::nan(""), HUGE_VAL, 2.5e7}) {
    RawEpoch bad = raw;
    for (SignalObservation& o : bad.observations) {
      o.pseudorange_m = value;
      o.doppler_hz = value;
      o.cn0_dbhz = value;
    }
    CAPTURE(value);
    const Solved solved = solve(sky, bad);
    CHECK(solved.point.status != PointStatus::kOk);
    CHECK(solved.epoch->satellites.size() > 5);
  }
}

// The covariance must say what the scatter is: NEES of 400 epochs whose noise has exactly the sigma
// that each measurement claims.
TEST_CASE("covariance agrees with the scatter of noisy solutions") {
  SimulatedReceiver receiver = moving_receiver();
  receiver.signals = {{{'1', 'C'}, 45.0}};
  const SimulatedSky sky = sky_of({gps_walker(), galileo_walker()});
  const RawEpoch clean = simulate_epoch(sky, receiver, 0.0);
  const Solved reference = solve(sky, clean, receiver.p_e);
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  double nees_p = 0.0, nees_v = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    RawEpoch raw = clean;
    for (const Measurement& m : reference.epoch->measurements) {
      const SatelliteId id = reference.epoch->satellites[m.satellite_index].satellite;
      const double noise = m.sigma * normal(generator);
      for (SignalObservation& o : raw.observations) {
        if (o.satellite != id) continue;
        if (m.observable == Observable::kCode) o.pseudorange_m += noise;
        if (m.observable == Observable::kDoppler) {
          o.doppler_hz += noise / wavelength_m(id.system, m.code.band);
        }
      }
    }
    const Solved solved = solve(sky, raw, receiver.p_e);
    REQUIRE(solved.point.status == PointStatus::kOk);
    const Eigen::Vector3d dp = solved.point.p_e - receiver.p_e;
    const Eigen::Vector3d dv = solved.point.v_e - receiver.v_e;
    nees_p += dense::nees(dp, solved.point.covariance_p_e) / kRuns;
    nees_v += dense::nees(dv, solved.point.covariance_v_e) / kRuns;
  }
  std::cout << "point solution NEES of 3: position " << nees_p << ", velocity " << nees_v << "\n";
  // Mean of 400 chi-square(3): 3 +- 0.37 at three sigma.
  for (const double nees : {nees_p, nees_v}) {
    CHECK(nees > 3.0 - 0.37);
    CHECK(nees < 3.0 + 0.37);
  }
}

TEST_CASE("LEO satellites at 970 km are used whatever the receiver's clock, negative ranges too") {
  const SimulatedSky sky = sky_of({gps_walker(), {System::kLeo, 19, 21, 7'348e3, 0.96, 0.0001}});
  SimulatedReceiver receiver = moving_receiver();
  receiver.elevation_mask = 0.27;
  for (const double clock_s : {-3.5e-3, 3.5e-3, -4.5e-3, -20e-3}) {
    receiver.clock_s = clock_s;
    const RawEpoch raw = simulate_epoch(sky, receiver, 0.0);
    double shortest = 1e9;
    for (const SignalObservation& o : raw.observations) {
      shortest = std::min(shortest, o.pseudorange_m);
    }
    const Solved solved = solve(sky, raw);
    CAPTURE(clock_s, shortest);
    if (clock_s < -4e-3) CHECK(shortest < 2e5);
    REQUIRE(solved.point.status == PointStatus::kOk);
    int leo = 0;
    for (const SatelliteInView& view : solved.epoch->satellites) {
      CHECK(view.reason == Reason::kUsed);
      leo += view.satellite.system == System::kLeo ? 1 : 0;
    }
    CHECK(leo >= 8);
    CHECK((solved.point.p_e - receiver.p_e).norm() < 0.02);
  }
}
