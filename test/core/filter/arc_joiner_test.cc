#include "core/filter/arc_joiner.h"

#include "core/filter/state/ambiguities.h"
#include "core/gnss/measurement/weighting.h"
#include "gps_pair.h"
#include "support/catch.h"

using namespace leonav;
using test::kL1;
using test::kL2;

namespace {

constexpr double kGap_s = 20.0;
constexpr double kOnePair = 0.5;  // of one pair of arcs alone no more is known
const SatelliteId kSatellite{System::kGps, 7};

// Two arcs of one satellite, parted by a gap and by 1000 and -400 cycles.
struct Scene {
  double cn0_before = 45.0, cn0_after = 45.0;
  double geometry_free_step_m = 0.0;
  bool half_cycle = false;
  double repaired_m = 0.0;      // by the second arc, of the first signal
  char second_attribute = 'W';  // of the second signal, in the second arc
  double factor = 1.0;          // of its last carrier
};

double cycles_m() {
  const IonosphereFree pair = ionosphere_free(kL1, kL2);
  return pair.gamma1 * kSpeedOfLight / kL1 * 1000.0 - pair.gamma2 * kSpeedOfLight / kL2 * 400.0;
}

class Run {
 public:
  explicit Run(const Scene& scene, bool join = true, double wrong = kOnePair)
      : estimate_(config(join, wrong)), joiner_(config(join, wrong)) {
    // The first epoch shows how strong the signal is directly.
    observe(1, 0.0, 45.0, 2.0, {}, false);
    observe(1, 1.0, scene.cn0_before, 2.0, {}, false);
    // Carriers are continuous over an arc: a half cycle found later was in it from the start.
    const double geometry_free_m = 2.0 + 1000.0 * kSpeedOfLight / kL1 +
                                   400.0 * kSpeedOfLight / kL2 + scene.geometry_free_step_m +
                                   scene.repaired_m;
    second_attribute_ = scene.second_attribute;
    observe(2, 1.0 + kGap_s, scene.cn0_after, geometry_free_m, {}, scene.half_cycle);
    factor_ = scene.factor;
    observe(2, 2.0 + kGap_s, scene.cn0_after, geometry_free_m, {scene.repaired_m, 0.0},
            scene.half_cycle);
    const double repaired = ionosphere_free(kL1, kL2).gamma1 * scene.repaired_m;
    estimate_.shift_ambiguity(estimate_.state().first_ambiguity() + 1,
                              cycles_m() + repaired + 0.04);
    joined = joiner_.join(&estimate_);
  }

  int joined = 0;
  const FilterState& state() const { return estimate_.state(); }
  double variance() const {
    return estimate_.covariance()(state().first_ambiguity(), state().first_ambiguity());
  }

 private:
  static EkfConfig config(bool join, double wrong) {
    EkfConfig config;
    config.join_arcs = join;
    config.wrong_join_probability = wrong;
    return config;
  }

  void observe(std::uint32_t arc, double t, double cn0_dbhz, double geometry_free_m,
               std::array<double, 2> repaired_m, bool half_cycle) {
    const IonosphereFree pair = ionosphere_free(kL1, kL2);
    MeasurementEpoch epoch;
    epoch.time = GpsTime::from_week_and_tow(2200, 1000.0 + t);
    epoch.satellites.emplace_back();
    epoch.satellites[0].satellite = kSatellite;
    epoch.satellites[0].cn0_dbhz = cn0_dbhz;
    epoch.satellites[0].elevation = 1.0;
    Measurement code;
    code.sigma = 1.0;
    Measurement carrier;
    carrier.observable = Observable::kCarrier;
    carrier.sigma = 0.01;
    carrier.arc = arc;
    carrier.code = {'1', 'C'};
    carrier.second_code = {'2', second_attribute_};
    carrier.cycles.wavelength_m = {kSpeedOfLight / kL1, kSpeedOfLight / kL2};
    carrier.cycles.gamma = {pair.gamma1, pair.gamma2};
    carrier.cycles.geometry_free_m = geometry_free_m;
    carrier.cycles.geometry_free_noise = {0.003, 0.0003, 0.00001};
    carrier.cycles.repaired_m = repaired_m;
    carrier.cycles.half_cycle_unresolved = half_cycle;
    epoch.measurements.push_back(code);
    epoch.measurements.push_back(carrier);
    if (find_ambiguity(state().ambiguities, arc) == kNoAmbiguity) {
      Ambiguity ambiguity;
      ambiguity.arc = arc;
      ambiguity.satellite = kSatellite;
      ambiguity.started = epoch.time;
      estimate_.add_ambiguity(ambiguity, arc == 1 ? 0.02 : 0.06);
    }
    FilterMeasurement used;
    used.index = 1;
    used.observable = Observable::kCarrier;
    used.factor = factor_;
    used.ambiguity = state().first_ambiguity() + find_ambiguity(state().ambiguities, arc);
    FilterMeasurements measurements;
    measurements.push_back(used);
    errors_.begin_epoch(epoch);
    joiner_.observe(epoch, measurements, errors_, false, state());
  }

  char second_attribute_ = 'W';
  double factor_ = 1.0;
  StateEstimate estimate_;
  ArcJoiner joiner_;
  LearnedErrors errors_{EkfConfig()};
};

}  // namespace

TEST_CASE("arcs that differ by whole cycles are joined") {
  const Run run{Scene{}};
  CHECK(run.joined == 1);
  REQUIRE(run.state().ambiguities.size() == 1);
  CHECK(run.state().ambiguities[0].arc == 2);
  // The earlier ambiguity is 0 within 2 cm and the later one was 4 cm off within 6 cm.
  CHECK(run.state().ambiguities[0].value_m == Approx(cycles_m()).margin(0.01));
  CHECK(run.variance() < 0.025 * 0.025);
  CHECK(run.variance() > 0.015 * 0.015);
}

TEST_CASE("an ambiguity keeps what is known of a wrong join") {
  const Run run{Scene{}};
  REQUIRE(run.state().ambiguities.size() == 1);
  CHECK(run.state().ambiguities[0].wrong_join_probability > 0.0);
  CHECK(run.state().ambiguities[0].wrong_join_probability < kOnePair);
  // The nearest other cycles that fit are one of each frequency away, or further.
  const IonosphereFree pair = ionosphere_free(kL1, kL2);
  CHECK(run.state().ambiguities[0].wrong_join_m >
        0.9 * (pair.gamma1 * kSpeedOfLight / kL1 + pair.gamma2 * kSpeedOfLight / kL2));
}

TEST_CASE("arcs of other signals on the same frequencies are not joined") {
  CHECK(Run(Scene{.second_attribute = 'L'}).joined == 0);
}

TEST_CASE("a carrier that an update has rejected says nothing of its arc") {
  // The half cycle that is repaired at that epoch is not known without it.
  CHECK(Run(Scene{.half_cycle = true, .factor = 0.0}).joined == 0);
}

TEST_CASE("half cycles repaired in an arc are not whole cycles of another") {
  const Run run{Scene{.repaired_m = 0.5 * kSpeedOfLight / kL1}};
  CHECK(run.joined == 1);
}

TEST_CASE("arcs are joined alike every time") {
  const Run a{Scene{}}, b{Scene{}};
  CHECK(a.state().ambiguities[0].value_m == b.state().ambiguities[0].value_m);
  CHECK(a.variance() == b.variance());
}

TEST_CASE("one pair of arcs does not show that a receiver counts whole cycles") {
  CHECK(Run(Scene{}, true, EkfConfig().wrong_join_probability).joined == 0);
}

TEST_CASE("arcs are not joined where that is switched off") {
  CHECK(Run(Scene{}, false).joined == 0);
}

TEST_CASE("a signal weaker than it has been is not joined") {
  CHECK(Run(Scene{.cn0_before = 38.0}).joined == 0);
  CHECK(Run(Scene{.cn0_after = 38.0}).joined == 0);
}

TEST_CASE("an unresolved half cycle is not joined") {
  CHECK(Run(Scene{.half_cycle = true}).joined == 0);
}

TEST_CASE("a geometry-free change that is no cycles' is not joined") {
  CHECK(Run(Scene{.geometry_free_step_m = 0.08}).joined == 0);
}
