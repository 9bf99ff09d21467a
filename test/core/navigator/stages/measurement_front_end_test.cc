// What other coefficients of the ionosphere's model do to the measurements of the next epoch.
#include "core/navigator/stages/internal/measurement_front_end.h"

#include <cmath>
#include <memory>

#include "core/gnss/propagation/ionosphere.h"
#include "support/catch.h"
#include "support/drive/navigator_config.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {
namespace {

const KlobucharModel kQuiet = {.alpha = {1e-8, 0, 0, 0}, .beta = {1e5, 0, 0, 0}, .valid = true};
const KlobucharModel kActive = {.alpha = {6e-8, 0, 0, 0}, .beta = {2.6e5, 0, 0, 0}, .valid = true};

struct Receiver {
  SimulatedSky sky;
  SimulatedReceiver receiver;
  NavigatorConfig config = drive_navigator_config({}, MotionModel::kConstantVelocity);
  std::unique_ptr<MeasurementFrontEnd> front_end;
  std::unique_ptr<Ekf> filter;
  double t = 0.0;

  Receiver() {
    sky.add(gps_walker());
    config.gnss.code_combination = CodeCombination::kSingleFrequency;
    front_end = std::make_unique<MeasurementFrontEnd>(config);
    filter = std::make_unique<Ekf>(config.ekf, ImuErrorModel(), Eigen::Vector3d::Zero());
    for (const Ephemeris& e : sky.ephemerides) front_end->add(e);
    PointSolution point;
    point.p_e = receiver.p_e;
    point.covariance_p_e.setIdentity();
    point.covariance_v_e.setIdentity();
    filter->initialize(kSkyEpoch, point);
  }
  EpochWork work() {
    EpochWork next;
    next.raw = simulate_epoch(sky, receiver, t);
    next.time = next.raw.time;
    t += 1.0;
    return next;
  }
  double measure() {
    front_end->measure(work(), *filter);
    return front_end->measurements().ionosphere_step_m;
  }
  double zenith_m(const KlobucharModel& model) const {
    return zenith_ionosphere_m(model, to_geodetic(receiver.p_e), kSkyEpoch);
  }
};

}  // namespace

TEST_CASE("a step of the modelled zenith delay is told with the next epoch and with no other") {
  Receiver r;
  CHECK(r.measure() == 0.0);
  r.front_end->add(kActive);
  const double step_m = r.zenith_m(kActive) - r.zenith_m({});
  REQUIRE(std::abs(step_m) > 1.0);
  CHECK(r.measure() == Approx(step_m).epsilon(1e-3));
  CHECK(r.measure() == 0.0);
  r.front_end->add(kActive);
  CHECK(r.measure() == 0.0);
  // Two between epochs add up.
  r.front_end->add(KlobucharModel{});
  r.front_end->add(kQuiet);
  CHECK(r.measure() == Approx(r.zenith_m(kQuiet) - r.zenith_m(kActive)).epsilon(1e-3));
}

TEST_CASE("coefficients that come before the first epoch are no step") {
  Receiver r;
  r.front_end->add(kActive);
  CHECK(r.measure() == 0.0);
}

TEST_CASE("the bands' delays do not jump where other coefficients come, nor do the codes") {
  Receiver followed, undisturbed;
  // The sky has the delay of these coefficients, and so has the model before and after.
  const auto band_difference = [](Receiver& r) {
    double sum = 0.0;
    int codes = 0;
    for (const Measurement& code : r.front_end->measurements().measurements) {
      if (code.observable != Observable::kCode || code.code.band != '2') continue;
      const SatelliteInView& view = r.front_end->measurements().satellites[code.satellite_index];
      sum += code.value - (view.p_e - r.receiver.p_e).norm();
      ++codes;
    }
    REQUIRE(codes > 5);
    return sum / codes;
  };
  for (int i = 0; i < 60; ++i) followed.measure(), undisturbed.measure();
  const double slant = 1.4;  // of a satellite at the median elevation, or so
  followed.front_end->add(kActive);
  followed.measure(), undisturbed.measure();
  const double step_m = followed.zenith_m(kActive) - followed.zenith_m({});
  // As much as on the first band, and not 1.65 times that.
  CHECK(band_difference(followed) - band_difference(undisturbed) ==
        Approx(-slant * step_m).epsilon(0.25));
}

}  // namespace leonav::test
