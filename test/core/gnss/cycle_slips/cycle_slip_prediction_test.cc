// What an inertial prediction of the position change adds to the slip detectors: where few
// satellites are in view, many slip at once, and the slips are small.
#include "support/catch.h"
#include "support/slips/slip_bursts.h"
#include "support/slips/slip_scene_1hz.h"

namespace leonav {
namespace {

constexpr double kPrediction_m = 0.01;  // 1 sigma of each axis over 1 s: a good IMU

struct SlipCase {
  const char* name;
  std::size_t (*slipping)(std::size_t count);
  std::size_t satellites;  // 0: all
  // Enough rows agree to tell which have slipped, given a prediction: up to half of the spare ones.
  bool decidable;
};
constexpr auto kOne = [](std::size_t) { return std::size_t{1}; };
constexpr auto kHalf = [](std::size_t count) { return (count - 1) / 2; };
constexpr auto kAllButThree = [](std::size_t count) { return count - std::min(count, 3ul); };
constexpr SlipCase kSlipCases[] = {
    {"all in view, one slips", kOne, 0, true},
    {"all in view, half of them slip", kHalf, 0, true},
    {"all in view, all but three slip", kAllButThree, 0, false},
    {"6 in view, one slips", kOne, 6, true},
    {"6 in view, 2 slip", kHalf, 6, true},
    {"6 in view, 3 slip", kAllButThree, 6, false},
    {"5 in view, one slips", kOne, 5, true},
    {"5 in view, 2 slip", kHalf, 5, true},
    {"4 in view, one slips", kOne, 4, true},
};

struct Detection {
  const char* name;
  bool pairs, other_detectors;
};
constexpr Detection kDetections[] = {
    {"Single frequency", false, true},
    {"Pairs", true, true},
    {"Pairs, nothing but the range change", true, false},
};

test::SlipCounts find(const test::SlipScene& whole, const Detection& receiver, const SlipCase& c,
                      bool one_cycle) {
  test::SlipScene scene = whole;
  scene.second_signals = receiver.pairs;
  CycleSlipConfig config;
  config.use_geometry_free = config.use_melbourne_wuebbena = config.use_doppler =
      receiver.other_detectors;
  if (c.satellites > 0) {
    test::SlipRun all(scene, config);
    all.run();
    test::leave_satellites(c.satellites, all.going(), &scene.epochs);
  }
  test::SlipRun clean(scene, config);
  clean.run();
  test::SlipBursts bursts;
  bursts.slipping = c.slipping;
  bursts.one_cycle = one_cycle;
  const auto slips = test::draw_bursts(clean.going(), bursts, 7);
  return test::SlipRun(scene, config).run(slips);
}

void print_heading(const Detection& receiver, bool one_cycle) {
  std::cout << '\n'
            << receiver.name << (one_cycle ? ", slips of 1 cycle" : ", slips of 1 to 1000 cycles")
            << "; at once %, false/1000\n"
            << std::left << std::setw(34) << "" << std::right << std::setw(6) << "slips"
            << std::setw(18) << "predicted to 1 cm" << std::setw(18) << "no prediction" << '\n';
}

void print(const char* name, const test::SlipCounts& with, const test::SlipCounts& without) {
  std::cout << std::left << std::setw(34) << name << std::right << std::setw(6) << with.injected;
  for (const test::SlipCounts* c : {&with, &without}) {
    std::cout << "  |" << std::fixed << std::setprecision(2) << std::setw(7)
              << 100.0 * c->detected() << std::setw(8) << 1000.0 * c->false_rate();
  }
  std::cout << '\n' << std::defaultfloat;
}

}  // namespace

TEST_CASE("What a prediction adds to the slip detectors", "[cycle_slip]") {
  test::SlipScene1HzOptions options;
  options.prediction_sigma_m = kPrediction_m;
  test::SlipScene1Hz predicted(options);
  options.prediction_sigma_m = -1.0;
  test::SlipScene1Hz unpredicted(options);
  for (const Detection& receiver : kDetections) {
    for (const bool one_cycle : {true, false}) {
      print_heading(receiver, one_cycle);
      for (const SlipCase& c : kSlipCases) {
        const test::SlipCounts with = find(predicted.scene(), receiver, c, one_cycle);
        const test::SlipCounts without = find(unpredicted.scene(), receiver, c, one_cycle);
        print(c.name, with, without);
        CAPTURE(receiver.name, one_cycle, c.name);
        CHECK(with.injected >= 50);
        // Nothing ends where nothing slips.
        CHECK(with.false_alarms == with.false_at_slips);
        CHECK(without.false_alarms == without.false_at_slips);
        const bool all_detectors = receiver.pairs && receiver.other_detectors;
        // An arc of one frequency ends as well where its slip cannot be told from the rest.
        if (c.decidable || !receiver.pairs || all_detectors) CHECK(with.detected() >= 0.995);
        if (c.decidable || all_detectors) {
          CHECK(with.false_rate() <= 0.001);
          CHECK(with.detected() >= without.detected());
        }
        // It is the prediction that finds them: five rows determine four unknowns and no more.
        if (c.decidable && c.satellites > 0 && c.satellites <= 5 && one_cycle && !all_detectors)
          CHECK((without.detected() < 0.1 || (!receiver.pairs && without.false_rate() > 0.05)));
      }
    }
  }
}

}  // namespace leonav
