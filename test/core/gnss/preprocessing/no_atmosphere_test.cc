// Signals of a simulator without an atmosphere: gnss.atmosphere none takes no delay off them.
#include <memory>

#include "core/gnss/positioning/point_solution.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct SolvedEpoch {
  bool is_good = false;
  double error_m = 0.0;
  std::unique_ptr<MeasurementEpoch> epoch = std::make_unique<MeasurementEpoch>();
};

// One epoch without noise, in motion.
SolvedEpoch solve(bool is_delayed, const GnssConfig& config) {
  SimulatedReceiver receiver;
  receiver.v_e = {3.0, -2.0, 5.0};
  receiver.atmosphere = is_delayed;
  SimulatedSky sky;
  sky.add(gps_walker());
  sky.add(galileo_walker());
  SolvedEpoch solved;
  const PointSolution point =
      solve_point(simulate_epoch(sky, receiver, 0.0), sky.ephemeris_store, config, RobustConfig{},
                  Eigen::Vector3d::Zero(), solved.epoch.get());
  solved.is_good = point.status == PointStatus::kOk;
  solved.error_m = (point.p_e - receiver.p_e).norm();
  return solved;
}

}  // namespace

TEST_CASE("without an atmosphere no delay is modelled, of pairs and of one frequency") {
  for (const CodeCombination codes :
       {CodeCombination::kIonosphereFree, CodeCombination::kSingleFrequency}) {
    CAPTURE(static_cast<int>(codes));
    GnssConfig standard = default_gnss_config();
    standard.code_combination = codes;
    GnssConfig none = standard;
    none.has_atmosphere = false;
    for (const bool is_delayed : {true, false}) {
      const GnssConfig& right = is_delayed ? standard : none;
      const GnssConfig& wrong = is_delayed ? none : standard;
      const SolvedEpoch solved = solve(is_delayed, right);
      CHECK(solved.is_good);
      CHECK(solved.error_m < 0.1);
      const SolvedEpoch contradicted = solve(is_delayed, wrong);
      CHECK((!contradicted.is_good || contradicted.error_m > 1.0));
    }
    const SolvedEpoch solved = solve(false, none);
    for (const SatelliteInView& view : solved.epoch->satellites) {
      CHECK(view.troposphere_m == 0.0);
      CHECK(view.ionosphere_l1_m == 0.0);
    }
  }
}
