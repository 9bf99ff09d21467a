// Steps of the codes' clock and of one system's time, as codes and carriers of a standing receiver
// show them, against a filter that has seen none.
#include <cmath>
#include <functional>

#include "carrier_receiver.h"
#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace ekf_index;
using namespace synthetic;
using Eigen::Vector3d;

constexpr int kBefore = 40;  // epochs

EkfConfig receiver_config() {
  EkfConfig config = static_config();
  config.robust.enabled = true;
  config.clock = ClockModel();
  return config;
}

EkfConfig vague_config() {
  EkfConfig config = receiver_config();
  config.static_point = false;
  config.acceleration_noise_horizontal = config.acceleration_noise_vertical = 100.0;
  return config;
}

// What to add to a measurement of a satellite, `k` epochs after kBefore (from 1).
using Step = std::function<double(const Measurement&, System, int)>;

Step on_codes(double step_m) {
  return [=](const Measurement& m, System, int) {
    return m.observable == Observable::kCode ? step_m : 0.0;
  };
}

Step on_galileo(double step_m, bool carriers) {
  return [=](const Measurement& m, System system, int) {
    const bool moves = carriers || m.observable == Observable::kCode;
    return system == System::kGalileo && moves ? step_m : 0.0;
  };
}

struct Outcome {
  double apart_m = 0.0;  // at most, from the filter that has seen no step
  double code_step_m = 0.0, inter_system_step_m = 0.0;  // sums
  int slipped = 0, forgotten = 0;
  int rejected_late = 0;  // codes, from the fourth epoch on
  std::size_t arcs = 0;
};

Outcome run(const EkfConfig& config, std::size_t gps, int epochs, const Step& step_of) {
  Receiver receiver(11, gps), same(11, gps);
  Ekf filter = static_filter(&receiver, config);
  Ekf undisturbed = static_filter(&same, config);
  Outcome outcome;
  for (int k = 1 - kBefore; k <= epochs; ++k) {
    MeasurementEpoch epoch = receiver.measure(kStep_s * (k + kBefore));
    for (Measurement& m : epoch.measurements) {
      const System system = epoch.satellites[m.satellite_index].satellite.system;
      if (k >= 1) m.value += step_of(m, system, k);
    }
    const EkfUpdateResult result = step(&filter, epoch);
    step(&undisturbed, same.measure(kStep_s * (k + kBefore)));
    outcome.code_step_m += result.code_step_m;
    for (const double step_m : result.inter_system_step_m) outcome.inter_system_step_m += step_m;
    outcome.slipped += static_cast<int>(result.slipped.size());
    outcome.forgotten += result.prediction_widened[0] > 0.0 ? 1 : 0;
    if (k >= 4) outcome.rejected_late += result.rejected[0];
    outcome.apart_m =
        std::max(outcome.apart_m, (filter.state().p_e - undisturbed.state().p_e).norm());
  }
  outcome.arcs = filter.filter_state().ambiguities.size();
  return outcome;
}

}  // namespace

TEST_CASE("codes that step by 2 to 1000 m against the carriers cost no arc and no centimetre") {
  for (const bool vague : {false, true}) {
    for (const double step_m : {2.0, -3.0, 10.0, 37.0, -150.0, 999.0}) {
      const Outcome outcome =
          run(vague ? vague_config() : receiver_config(), 5, 40, on_codes(step_m));
      CAPTURE(vague, step_m, outcome.apart_m, outcome.code_step_m);
      CHECK(outcome.code_step_m == Approx(step_m).margin(0.6));
      CHECK(outcome.inter_system_step_m == 0.0);
      CHECK(outcome.apart_m < (vague ? 0.02 : 0.005));
      CHECK(outcome.slipped == 0);
      CHECK(outcome.forgotten == 0);
      CHECK(outcome.rejected_late == 0);
      CHECK(outcome.arcs == 8);
    }
  }
}

TEST_CASE("no step is found where there is none, nor one within the codes' noise") {
  for (const double step_m : {0.0, 0.2}) {
    const Outcome outcome = run(receiver_config(), 4, 400, on_codes(step_m));
    CHECK(outcome.code_step_m == 0.0);
    CHECK(outcome.inter_system_step_m == 0.0);
  }
}

TEST_CASE("codes that step every eleventh epoch, as a phone's do, do not move a standing antenna") {
  const Outcome outcome = run(receiver_config(), 5, 88, [](const Measurement& m, System, int k) {
    return m.observable == Observable::kCode ? 30.0 * (k / 11) : 0.0;
  });
  CAPTURE(outcome.apart_m);
  CHECK(outcome.code_step_m == Approx(240.0).margin(2.0));
  CHECK(outcome.apart_m < 0.01);
  CHECK(outcome.slipped == 0);
}

TEST_CASE(
    "a step of one system's time is taken by its clock, whether its carriers make it or not") {
  for (const bool vague : {false, true}) {
    for (const bool carriers : {false, true}) {
      for (const double step_m : {5.0, 50.0, -1e5}) {
        CAPTURE(vague, carriers, step_m);
        const Outcome outcome =
            run(vague ? vague_config() : receiver_config(), 4, 40, on_galileo(step_m, carriers));
        CAPTURE(outcome.apart_m, outcome.inter_system_step_m);
        CHECK(outcome.apart_m < (vague ? 0.05 : 0.01));
        CHECK(outcome.rejected_late == 0);
        CHECK(outcome.forgotten == 0);
        CHECK(outcome.slipped == 0);
        CHECK(outcome.arcs == 8);
        // Below 15 sigma, or with a vague prediction, the update may have followed by itself.
        if (!vague && std::abs(step_m) > 5.0)
          CHECK(std::abs(outcome.inter_system_step_m) == Approx(std::abs(step_m)).margin(3.0));
      }
    }
  }
}

TEST_CASE("one epoch of one system's codes and carriers far out leaves no trace") {
  const Outcome outcome =
      run(receiver_config(), 4, 10, [](const Measurement&, System system, int k) {
        return system == System::kGalileo && k == 1 ? 50.0 : 0.0;
      });
  CHECK(outcome.inter_system_step_m == Approx(0.0).margin(2.0));  // there and back
  CHECK(outcome.apart_m < 0.01);
  CHECK(outcome.slipped == 0);
}

TEST_CASE("a system with few satellites whose codes are locked out starts anew") {
  const Outcome outcome = run(receiver_config(), 6, 10, on_galileo(500.0, true));
  const Outcome later = run(receiver_config(), 6, 30, on_galileo(500.0, true));
  CAPTURE(later.apart_m);
  CHECK(outcome.rejected_late >= 10);  // its two codes, epoch after epoch
  CHECK(later.rejected_late < outcome.rejected_late + 8);
  CHECK(later.inter_system_step_m == Approx(500.0).margin(3.0));
  CHECK(later.apart_m < 0.01);
}

TEST_CASE("innovations without the clock are those against each base's own median") {
  FilterMeasurements measurements;
  for (int i = 0; i < 11; ++i) {
    FilterMeasurement m;
    const int base = i < 4 ? 0 : i < 9 ? 1 : 2;  // four, five and two
    m.index = static_cast<std::size_t>(i);
    m.row(kClock + base) = 1.0;
    m.innovation = 0.1 * i + (base == 0 ? 70.0 : 0.0);
    m.variance = 1.0;
    measurements.push_back(m);
  }
  const EkfCovariance P = EkfCovariance::Identity(kSize, kSize);
  const ClockRemovedInnovations table =
      clock_removed_innovations(measurements, Observable::kCode, P);
  REQUIRE(table.size() == 11);
  // The two of the third base go with the five of the second, whose median with them is 0.7.
  for (const ClockRemovedInnovation& entry : table) {
    const double middle = entry.index < 4 ? 70.15 : 0.7;
    CHECK(entry.innovation == Approx(measurements[entry.index].innovation - middle).margin(1e-12));
  }
}

}  // namespace leonav
