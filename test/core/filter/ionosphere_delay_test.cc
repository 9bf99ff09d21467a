// The zenith delay that the model of the ionosphere leaves: drawn, put into codes of one frequency,
// and estimated.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/filter/ekf.h"
#include "core/filter/nees.h"
#include "core/filter/state/ekf_state.h"
#include "core/filter/synthetic.h"
#include "support/catch.h"
#include "support/drive/white_errors.h"

namespace leonav {
namespace {

using namespace synthetic;
using Eigen::Vector3d;
using ekf_index::kIonosphere;

constexpr double kZenithSigma = 3.0, kNoise = 0.5;

double mapping(const SatelliteInView& satellite) { return 1.0 / std::sin(satellite.elevation); }

// A receiver that moves and keeps time as its filter assumes, with codes of one frequency.
class DelayedReceiver {
 public:
  explicit DelayedReceiver(std::uint64_t seed) : noise_(seed) {
    truth_.p_antenna_e = start_position();
    truth_.clocks.offset_m.setConstant(100.0);
    delay_m_ = kZenithSigma * noise_.normal();
    filter_.initialize(kStart, point_near(truth_, 10.0, 0.1, &noise_));
  }
  // Without `told` the filter takes the delay for an error that each code has for itself.
  void run(int seconds, bool told = true) {
    for (int i = 0; i < seconds; ++i) {
      t_s_ += 1.0;
      move_a_second(config_, C_en_at(start_position()), &truth_, &noise_);
      advance_clocks(config_.clock, 1.0, &truth_.clocks, &noise_);
      const double decay = std::exp(-1.0 / 3600.0);
      delay_m_ = decay * delay_m_ + kZenithSigma * std::sqrt(1.0 - decay * decay) * noise_.normal();
      MeasurementEpoch epoch =
          measure(kStart.plus_seconds(t_s_), sky_, truth_, kNoise, 0.02, &noise_);
      epoch.ionosphere_step_m = std::exchange(pending_step_m_, 0.0);
      for (Measurement& code : epoch.measurements) {
        if (code.observable != Observable::kCode) continue;
        const double slant = mapping(epoch.satellites[code.satellite_index]);
        code.value += slant * delay_m_;
        const double variance = slant * slant * kZenithSigma * kZenithSigma;
        code.sigma = std::sqrt(code.sigma * code.sigma + variance);
        code.correlated_sigma = std::sqrt(variance);
        code.correlation_time_s = 900.0;
        if (told) code.ionosphere = {slant, kZenithSigma, variance};
      }
      filter_.predict({}, epoch.time);
      filter_.update(epoch);
    }
  }
  // Other coefficients of the model take `step_m` of the delay on them from the next epoch on.
  void step_model(double step_m, bool told) {
    delay_m_ -= step_m;
    if (told) pending_step_m_ = step_m;
  }
  void see(System system, std::size_t most) {
    sky_ = eight_satellites();
    std::erase_if(sky_, [&](const SatelliteInView& v) { return v.satellite.system != system; });
    sky_.resize(std::min(most, sky_.size()));
  }
  void restart() { filter_.initialize(kStart, PointSolution()); }
  double delay_error() const { return filter_.filter_state().ionosphere_m - delay_m_; }
  double delay_sigma() const { return std::sqrt(filter_.covariance()(kIonosphere, kIonosphere)); }
  Vector3d position_error_ned() const {
    return C_en_at(start_position()).transpose() * (filter_.state().p_e - truth_.p_antenna_e);
  }
  Vector3d position_sigma_ned() const {
    const Eigen::Matrix3d C_ne = C_en_at(start_position()).transpose();
    const Eigen::Matrix3d P = filter_.covariance().topLeftCorner<3, 3>();
    return (C_ne * P * C_ne.transpose()).diagonal().cwiseSqrt();
  }
  const Ekf& filter() const { return filter_; }

 private:
  static EkfConfig config() {
    EkfConfig config = white_error_config();
    config.robust.enabled = false;
    return config;
  }
  Generator noise_;
  std::vector<SatelliteInView> sky_ = eight_satellites();
  Truth truth_;
  double delay_m_ = 0.0, pending_step_m_ = 0.0, t_s_ = 0.0;
  EkfConfig config_ = config();
  Ekf filter_{config_, ImuErrorModel(), Vector3d::Zero()};
};

TEST_CASE("the zenith delay is found, and errors are as large as the covariance says") {
  constexpr int kDraws = 60;
  double delay = 0.0;
  Vector3d position = Vector3d::Zero();
  for (int run = 0; run < kDraws; ++run) {
    DelayedReceiver receiver(static_cast<std::uint64_t>(run) + 1);
    receiver.run(20);
    delay += std::pow(receiver.delay_error() / receiver.delay_sigma(), 2) / kDraws;
    position += (receiver.position_error_ned().array() / receiver.position_sigma_ned().array())
                    .square()
                    .matrix() /
                kDraws;
    CHECK(receiver.delay_sigma() < 0.5 * kZenithSigma);
  }
  // 99.9 % of chi-square with 60 degrees of freedom over 60.
  for (const double mean : {delay, position.x(), position.y(), position.z()}) {
    CHECK(mean > 0.51);
    CHECK(mean < 1.67);
  }
}

TEST_CASE("a common delay does not make the horizontal position less certain") {
  DelayedReceiver told(7), untold(7);
  told.run(60);
  untold.run(60, false);
  CHECK(told.position_sigma_ned().head<2>().norm() <
        0.3 * untold.position_sigma_ned().head<2>().norm());
  CHECK(untold.delay_sigma() == 0.0);
  CHECK(untold.filter().filter_state().ionosphere_m == 0.0);
}

TEST_CASE("a delay that no code shows any more becomes uncertain again; a new start forgets it") {
  DelayedReceiver receiver(3);
  receiver.run(60);
  const double known = receiver.delay_sigma();
  receiver.run(600, false);
  CHECK(receiver.delay_sigma() > 1.2 * known);
  CHECK(receiver.delay_sigma() < kZenithSigma);
  receiver.restart();
  CHECK(receiver.filter().filter_state().ionosphere_m == 0.0);
  CHECK(receiver.delay_sigma() == 0.0);
}

TEST_CASE("a step of the model moves the delay by as much, once, and widens it by its square") {
  constexpr double kStep = 4.0;
  const auto after = [](double step_m) {
    DelayedReceiver receiver(5);
    receiver.see(System::kGps, 8);
    receiver.run(120);
    // One satellite of a system that begins: its clock is started from the predicted measurements,
    // which are then predicted again.
    receiver.see(System::kGalileo, 1);
    receiver.step_model(step_m, true);
    receiver.run(1);
    return receiver;
  };
  const DelayedReceiver stepped = after(kStep), undisturbed = after(0.0);
  const auto delay = [](const DelayedReceiver& r) {
    return r.filter().filter_state().ionosphere_m;
  };
  CHECK(delay(stepped) - delay(undisturbed) == Approx(-kStep).margin(0.3));
  CHECK(std::pow(stepped.delay_sigma(), 2) - std::pow(undisturbed.delay_sigma(), 2) ==
        Approx(kStep * kStep).epsilon(0.02));
  CHECK((stepped.position_error_ned() - undisturbed.position_error_ned()).norm() < 0.05);
}

TEST_CASE("other coefficients of the model move the delay and not the position") {
  constexpr double kStep = 4.0;
  const auto after = [](bool stepped, bool told) {
    DelayedReceiver receiver(5);
    receiver.run(120);
    if (stepped) receiver.step_model(kStep, told);
    receiver.run(1);
    return receiver;
  };
  const DelayedReceiver undisturbed = after(false, false), followed = after(true, true),
                        untold = after(true, false);
  const auto moved = [&](const DelayedReceiver& receiver) {
    return (receiver.position_error_ned() - undisturbed.position_error_ned()).norm();
  };
  CHECK(moved(followed) < 0.2);
  CHECK(moved(untold) > 4.0 * moved(followed));
  CHECK(std::abs(followed.delay_error() - undisturbed.delay_error()) < 0.2);
  CHECK(followed.delay_sigma() > undisturbed.delay_sigma());
}

}  // namespace
}  // namespace leonav
