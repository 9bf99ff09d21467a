// Is the covariance true with carriers, ambiguities and a wet delay? As ekf_nees_test.
#include <Eigen/Core>
#include <cmath>

#include "core/filter/ekf.h"
#include "nees.h"
#include "support/catch.h"
#include "support/drive/white_errors.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using synthetic::Generator;

using synthetic::kRuns;
using synthetic::nees;

}  // namespace

TEST_CASE("with carriers, errors are as large as the covariance says, standing and driving") {
  const bool moving = GENERATE(false, true);
  constexpr double kCode = 1.0, kDoppler = 0.05, kCarrier = 0.005, kWet = 0.1;
  constexpr int kEpochs = 100;
  EkfConfig config = white_error_config();
  config.use_carrier = true;
  config.static_point = !moving;
  config.robust.enabled = false;
  config.wet_delay_sigma_m = kWet;
  config.wet_delay_noise = 1e-4;
  const Eigen::Matrix3d C_en = synthetic::C_en_at(synthetic::start_position());
  double position = 0.0, wet = 0.0, ambiguity = 0.0, within = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Generator noise(static_cast<std::uint64_t>(run) + 1000);
    synthetic::Truth truth;
    truth.p_antenna_e = synthetic::start_position();
    truth.v_antenna_e = moving ? Vector3d(C_en * Vector3d{10.0, 5.0, 0.0}) : Vector3d::Zero();
    truth.clocks.offset_m.setConstant(5e4);
    double wet_m = kWet * noise.normal();
    Eigen::VectorXd ambiguities_m(8);
    for (double& value : ambiguities_m) value = 30.0 * noise.normal();
    Ekf filter(config, ImuErrorModel(), Vector3d::Zero());
    filter.initialize(synthetic::kStart, synthetic::point_near(truth, 3.0, 0.2, &noise));
    for (int k = 1; k <= kEpochs; ++k) {
      if (moving) synthetic::move_a_second(config, C_en, &truth, &noise);
      synthetic::advance_clocks(config.clock, 1.0, &truth.clocks, &noise);
      wet_m += config.wet_delay_noise * noise.normal();
      // The satellites rise and set by half a degree a minute.
      auto sky = synthetic::eight_satellites();
      for (SatelliteInView& view : sky) {
        const double turn = (view.satellite.number % 2 == 0 ? 1.5e-4 : -1.5e-4) * k;
        view = synthetic::satellite_at(view.satellite.system, view.satellite.number, view.azimuth,
                                       view.elevation + turn);
      }
      const GpsTime time = synthetic::kStart.plus_seconds(k);
      MeasurementEpoch epoch = synthetic::measure(time, sky, truth, kCode, kDoppler, &noise);
      synthetic::add_carriers(truth, ambiguities_m, wet_m, kCarrier, k, &noise, &epoch);
      filter.predict({}, time);
      filter.update(epoch);
      const Vector3d error_n = C_en.transpose() * (truth.p_antenna_e - filter.state().p_e);
      const Eigen::Matrix3d P_n =
          C_en.transpose() * filter.covariance().topLeftCorner<3, 3>() * C_en;
      for (int i = 0; i < 3; ++i)
        within += std::abs(error_n(i)) <= 3.0 * std::sqrt(P_n(i, i)) ? 1.0 : 0.0;
    }
    const auto& P = filter.covariance();
    position += nees(truth.p_antenna_e - filter.state().p_e, P.topLeftCorner<3, 3>());
    wet += nees(Eigen::VectorXd::Constant(1, wet_m - filter.filter_state().wet_delay_m),
                P.block<1, 1>(kWetDelay, kWetDelay));
    Eigen::VectorXd error(8);
    for (int i = 0; i < 8; ++i) {
      const Ambiguity& estimate = filter.filter_state().ambiguities[static_cast<std::size_t>(i)];
      error(i) = ambiguities_m(estimate.satellite.number - 1) + 10.0 * (estimate.arc / 100u) -
                 estimate.value_m;
    }
    ambiguity += nees(error, P.block<8, 8>(kSize, kSize));
  }
  const double share = within / (3.0 * kRuns * kEpochs);
  WARN((moving ? "driving" : "standing")
       << " with carriers: NEES position " << position / kRuns << " of 3, wet delay " << wet / kRuns
       << " of 1, ambiguities " << ambiguity / kRuns << " of 8; within 3 sigma " << 100.0 * share
       << " %");
  // 95 % bands of the mean of kRuns chi-square variables (Wilson-Hilferty).
  CHECK(position / kRuns > synthetic::kLeastNees3);
  CHECK(position / kRuns < synthetic::kMostNees3);
  CHECK(wet / kRuns > 0.74);
  CHECK(wet / kRuns < 1.30);
  CHECK(ambiguity / kRuns > 7.24);
  CHECK(ambiguity / kRuns < 8.80);
  CHECK(share > 0.99);
}

}  // namespace leonav
