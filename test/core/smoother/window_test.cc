// Windows over what happens to a filter: against the filter, and short ones against long ones.
#include "core/smoother/window.h"

#include <memory>
#include <iostream>
#include <cstdlib>

#include "core/smoother/smoother.h"
#include "drive_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr int kEpochs = 55;
constexpr int kSteps = 8;  // of Gauss and Newton, far more than it takes

// The largest distance from the filter, in its sigmas, over a drive whose window is solved at every
// epoch.
double most_apart_from_filter(const DriveOptions& options, int capacity) {
  Drive drive(options);
  Window window(capacity);
  ChainSolver chain(capacity);
  double most = 0.0;
  for (int i = 0; i < kEpochs; ++i) {
    const bool linked = feed(drive.step(), drive.lever_b(), &window);
    CHECK(linked == (i > 0));
    REQUIRE(iterate(&chain, drive.lever_b(), 2, &window));
    most = std::max(most, apart_in_sigmas(window.newest().state, drive.filter().whole_state(),
                                          drive.filter().covariance()));
    if (getenv("DBG")) { std::cout << i+1 << " " << most << " jump " << drive.result().clock_jump_m << " base " << drive.result().base_step_m[1] << " suspect " << drive.result().prediction_suspect << " used " << drive.result().used << "\n";
     const EkfCorrection e = difference(window.newest().state, drive.filter().whole_state());
     if (most>1e-3) { for (int q=0;q<e.size();++q) std::cout << e(q) << "/" << std::sqrt(drive.filter().covariance()(q,q)) << " "; std::cout << "\n"; } }
  }
  return most;
}

bool is_galileo(SatelliteId id) { return id.system == System::kGalileo; }
bool is_any(SatelliteId) { return true; }

struct Course {
  const char* name;
  void (*set)(DriveOptions*);
};

constexpr double kMillisecond_m = 299'792.458;

const Course kCourses[] = {
    {"nothing happens", [](DriveOptions*) {}},
    {"ambiguities wander", [](DriveOptions* options) { options->wander = 0.02; }},
    {"arcs end and begin", [](DriveOptions* options) { options->arc_epochs = 15; }},
    {"wandering arcs end and begin",
     [](DriveOptions* options) {
       options->arc_epochs = 15;
       options->wander = 0.02;
     }},
    {"a time base begins, goes and comes back",
     [](DriveOptions* options) {
       options->edit = [](int epoch, MeasurementEpoch* measured) {
         if (epoch < 17 || (epoch > 25 && epoch < 33)) remove_satellites(is_galileo, measured);
       };
     }},
    {"epochs without measurements",
     [](DriveOptions* options) {
       options->edit = [](int epoch, MeasurementEpoch* measured) {
         if (epoch % 9 == 4) remove_satellites(is_any, measured);
       };
     }},
    {"the clock steps by a millisecond",
     [](DriveOptions* options) {
       options->edit_truth = [](int epoch, Truth* truth) {
         if (epoch == 20 || epoch == 21) truth->clocks.offset_m.array() += kMillisecond_m;
       };
     }},
    {"codes step against carriers",
     [](DriveOptions* options) {
       options->edit = [](int epoch, MeasurementEpoch* measured) {
         for (Measurement& m : measured->measurements)
           if (m.observable == Observable::kCode && epoch >= 20) m.value += 3.0 * kMillisecond_m;
       };
     }},
    {"one time base steps",
     [](DriveOptions* options) {
       options->edit_truth = [](int epoch, Truth* truth) {
         if (epoch == 20) truth->clocks.offset_m(index_of(System::kGalileo)) += 500.0;
       };
     }},
};

}  // namespace

TEST_CASE("a window is the filter, whatever happens, as long as all is linear") {
  const Course& course = kCourses[GENERATE(range(0, 9))];
  const int capacity = GENERATE(5, 60);
  DriveOptions options;
  options.noise = 1e-4;
  course.set(&options);
  const double apart = most_apart_from_filter(options, capacity);
  WARN("window of " << capacity << ", " << course.name << ": " << apart
                    << " sigma from the filter");
  CHECK(apart < 3e-6);
}

TEST_CASE("what has left the window is not lost: a short window is a long one") {
  const Course& course = kCourses[GENERATE(range(0, 9))];
  DriveOptions options;
  course.set(&options);
  Drive drive(options);
  Window shorter(5), longer(60);
  ChainSolver chain(60);
  double most = 0.0, moved = 0.0;
  for (int i = 0; i < kEpochs; ++i) {
    const KeyframeInput& input = drive.step();
    feed(input, drive.lever_b(), &shorter);
    feed(input, drive.lever_b(), &longer);
    REQUIRE(iterate(&chain, drive.lever_b(), kSteps, &shorter));
    REQUIRE(iterate(&chain, drive.lever_b(), kSteps, &longer));
    const EkfCovariance& covariance = drive.filter().covariance();
    most =
        std::max(most, apart_in_sigmas(shorter.newest().state, longer.newest().state, covariance));
    moved = std::max(
        moved, apart_in_sigmas(longer.newest().state, drive.filter().whole_state(), covariance));
  }
  WARN(course.name << ": windows of 5 and 60 apart " << most << " sigma; from the filter "
                   << moved);
  CHECK(most < 1e-6);
}

}  // namespace leonav
