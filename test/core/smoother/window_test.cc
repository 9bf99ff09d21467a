// Windows over what happens to a filter: against the filter, and short ones against long ones.
#include "core/smoother/window.h"

#include <cmath>
#include <iterator>
#include <memory>

#include "core/smoother/smoother.h"
#include "smoother_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr int kEpochs = 55;
constexpr int kSteps = 8;  // of Gauss and Newton, far more than it takes

// The largest distance from the filter, in its sigmas, over a drive whose window is solved at every
// epoch.
double most_apart_from_filter(const DriveOptions& options, int capacity, double* stepped_m) {
  Drive drive(options);
  Window window(capacity);
  RtsSolver chain(capacity);
  double most = 0.0;
  for (int i = 0; i < kEpochs; ++i) {
    const bool follows_previous = feed(drive.step(), drive.lever_b(), &window);
    CHECK(follows_previous == (i > 0));
    *stepped_m += std::abs(drive.result().clock_jump_m);
    for (const double step_m : drive.result().inter_system_step_m) *stepped_m += std::abs(step_m);
    REQUIRE(iterate(&chain, drive.lever_b(), 2, &window));
    most = std::max(most, apart_in_sigmas(window.newest().state, drive.filter().filter_state(),
                                          drive.filter().covariance()));
  }
  return most;
}

bool is_galileo(SatelliteId id) { return id.system == System::kGalileo; }
bool is_any(SatelliteId) { return true; }

// The code of one frequency with this zenith ionosphere delay beyond the modelled one.
void make_single_frequency(double delay_m, const MeasurementEpoch& epoch, Measurement* code) {
  const double slant = 1.0 / std::sin(epoch.satellites[code->satellite_index].elevation);
  const double variance = 4.0 * slant * slant;
  code->value += slant * delay_m;
  code->ionosphere = {slant, 2.0, variance};
  code->correlated_sigma = std::sqrt(2.0 * variance);
  code->correlation_time_s = 900.0;
  code->sigma = std::hypot(code->sigma, code->correlated_sigma);
}

struct Course {
  const char* name;
  void (*set)(DriveOptions*);
  double steps_m = 0.0;    // of clocks, that the filter takes up
  double nonlinear = 1.0;  // times what others cost to be linearized for good
};

constexpr double kMillisecond_m = 299'792.458;

const Course kCourses[] = {
    {"nothing happens", [](DriveOptions*) {}},
    {"ambiguities wander", [](DriveOptions* options) { options->random_walk = 0.02; }},
    {"arcs end and begin", [](DriveOptions* options) { options->arc_epochs = 15; }},
    {"wandering arcs end and begin",
     [](DriveOptions* options) {
       options->arc_epochs = 15;
       options->random_walk = 0.02;
     }},
    {"a system begins, goes and comes back",
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
     },
     2.0 * kMillisecond_m},
    {"codes step against carriers",
     [](DriveOptions* options) {
       options->edit = [](int epoch, MeasurementEpoch* measured) {
         for (Measurement& m : measured->measurements)
           if (m.observable == Observable::kCode && epoch >= 20) m.value += 3.0 * kMillisecond_m;
       };
     },
     3.0 * kMillisecond_m},
    {"one system's time steps",
     [](DriveOptions* options) {
       options->gps_satellites = 4;
       options->edit_truth = [](int epoch, Truth* truth) {
         if (epoch == 20) truth->clocks.offset_m(index_of(System::kGalileo)) += 500.0;
       };
     },
     500.0},
    {"codes of one frequency come and go, and the model of the ionosphere steps",
     [](DriveOptions* options) {
       options->edit = [](int epoch, MeasurementEpoch* measured) {
         if (epoch == 30) measured->ionosphere_step_m = 1.0;
         if (epoch < 10 || epoch % 7 > 3) return;
         for (Measurement& m : measured->measurements)
           if (m.observable == Observable::kCode)
             make_single_frequency(epoch < 30 ? 1.0 : 0.0, *measured, &m);
       };
     }},
    {"constraints on the motion between keyframes",
     [](DriveOptions* options) { options->constrained = true; }},
    {"constraints and an odometer between keyframes",
     [](DriveOptions* options) { options->constrained = options->odometer = true; }},
    {"lever arm and time offset are estimated",
     [](DriveOptions* options) { options->calibrating = true; }, 0.0,
     400.0},  // an arm unknown to half a metre times an unknown attitude
};

}  // namespace

TEST_CASE("a window is the filter, whatever happens, as long as all is linear") {
  const Course& course = kCourses[GENERATE(range(std::size_t{0}, std::size(kCourses)))];
  const int capacity = GENERATE(5, 60);
  DriveOptions options;
  options.noise = 1e-4;
  options.carrier_sigma = 0.05;  // far above what is left of a range in a double, 4e-9 m
  course.set(&options);
  double stepped_m = 0.0;
  const double apart = most_apart_from_filter(options, capacity, &stepped_m);
  WARN("window of " << capacity << ", " << course.name << ": " << apart
                    << " sigma from the filter");
  CHECK(apart < 1e-6);
  CHECK(std::abs(stepped_m - course.steps_m) < 1.0);
}

// What leaves is linearized for good: what that costs goes with the square of the noise.
TEST_CASE("what has left the window is not lost: a short window is a long one") {
  const Course& course = kCourses[GENERATE(range(std::size_t{0}, std::size(kCourses)))];
  DriveOptions options;
  options.noise = GENERATE(1.0, 0.01);
  if (course.nonlinear > 1.0 && options.noise == 1.0) return;  // no bound that could be missed
  if (options.noise < 1.0) options.carrier_sigma = 0.05;
  course.set(&options);
  Drive drive(options);
  Window shorter(5), longer(60);
  RtsSolver chain(60);
  double most = 0.0, moved = 0.0;
  for (int i = 0; i < kEpochs; ++i) {
    const KeyframeInput& input = drive.step();
    feed(input, drive.lever_b(), &shorter);
    feed(input, drive.lever_b(), &longer);
    REQUIRE(iterate(&chain, drive.lever_b(), kSteps, &shorter));
    REQUIRE(iterate(&chain, drive.lever_b(), kSteps, &longer));
    const EkfCovariance& covariance = drive.filter().covariance();
    const FilterState& by_longer = longer.newest().state;
    most = std::max(most, apart_in_sigmas(shorter.newest().state, by_longer, covariance));
    moved = std::max(moved, apart_in_sigmas(by_longer, drive.filter().filter_state(), covariance));
  }
  WARN(course.name << ", noise " << options.noise << ": windows of 5 and 60 apart " << most
                   << " sigma; from the filter " << moved);
  CHECK(most < course.nonlinear * (options.noise < 1.0 ? 1e-6 : 3e-3));
}

TEST_CASE("a window of one keyframe is the filter with more than one pass") {
  DriveOptions options;
  options.noise = 1e-4;
  options.carrier_sigma = 0.05;
  Drive drive(options);
  const auto smoother = smoother_of(drive, 1);
  for (int i = 0; i < kEpochs; ++i) {
    const KeyframeInput& input = drive.step();
    const SmootherResult result = solve(input, smoother.get());
    REQUIRE(result.status == (i > 0 ? SmootherStatus::kOk : SmootherStatus::kStarted));
    REQUIRE(smoother->window().size() == 1);
    const EkfCovariance& covariance = drive.filter().covariance();
    CHECK(apart_in_sigmas(smoother->window().newest().state, drive.filter().filter_state(),
                          covariance) < 1e-6);
    // Inverted twice at every keyframe, which costs digits.
    CHECK(apart_in_correlations(result.covariance.topLeftCorner<9, 9>(),
                                covariance.topLeftCorner<9, 9>()) < 1e-5);
  }
}

}  // namespace leonav
