// What the estimator finds of an arc reaches the arcs and the report.
#include "core/gnss/preprocessing/carrier_preprocessor.h"

#include <cmath>
#include <vector>

#include "core/gnss/measurement/range_model.h"
#include "support/catch.h"
#include "support/start_time.h"

namespace leonav {
namespace {

using test::kAnyTime;

// Satellites on L1 at rest; fills `epoch` as the preparation of measurements does.
void add_carrier(CarrierPreprocessor* preprocessor, double t,
                 std::vector<SignalObservation>* signals, MeasurementEpoch* epoch,
                 std::uint16_t satellites) {
  signals->clear();
  *epoch = {};
  epoch->time = kAnyTime.plus_seconds(t);
  for (std::uint16_t n = 1; n <= satellites; ++n) {
    SignalObservation o;
    o.satellite = {System::kGps, n};
    o.code = {'1', 'C'};
    o.pseudorange_m = 2.2e7;
    o.carrier_cycles = 2.2e7 / wavelength_m(System::kGps, '1');
    o.doppler_hz = 0.0;
    o.lock_time_s = 50.0 + t;
    signals->push_back(o);
  }
  preprocessor->begin(epoch->time);
  for (const SignalObservation& signal : *signals)
    preprocessor->add_carrier({&signal, nullptr}, 0.8);
  for (const CarrierStatus& status : preprocessor->update_arcs().satellites) {
    SatelliteInView view;
    view.satellite = (*signals)[epoch->satellites.size()].satellite;
    view.p_e = Eigen::Vector3d(2.6e7, 0.0, 0.0);
    Measurement carrier;
    carrier.observable = Observable::kCarrier;
    carrier.satellite_index = static_cast<std::uint16_t>(epoch->satellites.size());
    carrier.arc = status.arc;
    epoch->satellites.push_back(view);
    epoch->measurements.push_back(carrier);
  }
}

void update_arcs(CarrierPreprocessor* preprocessor, double t,
                 std::vector<SignalObservation>* signals, MeasurementEpoch* epoch) {
  add_carrier(preprocessor, t, signals, epoch, 3);
  preprocessor->check_range_changes(Eigen::Vector3d(6.4e6, 0.0, 0.0), RangeChangePrior(), epoch);
}

// Eight satellites on L1, seen from the place where an antenna truly is.
void follow_from(const Eigen::Vector3d& antenna_p_e, const Eigen::Vector3d& predicted_p_e, double t,
                 CarrierPreprocessor* preprocessor, std::vector<SignalObservation>* signals,
                 MeasurementEpoch* epoch) {
  add_carrier(preprocessor, t, signals, epoch, 8);
  for (Measurement& carrier : epoch->measurements) {
    SatelliteInView& view = epoch->satellites[carrier.satellite_index];
    const double n = carrier.satellite_index;
    view.p_e =
        2.6e7 *
        Eigen::Vector3d(1.5, std::cos(2.4 * n), std::sin(2.4 * n) * (0.3 + 0.1 * n)).normalized();
    view.elevation = 0.8;
    carrier.code = {'1', 'C'};
    carrier.sigma = 0.003;
    preprocessor->set_wind_up(view.satellite, 0.0);
    carrier.value = predict_range(view, antenna_p_e).range_m + 5.0 * n + 100.0 * t;
  }
  RangeChangePrior prior;
  prior.change_is_free = false;
  prior.change_covariance.diagonal().fill(1e-6);  // one who is sure to stand
  preprocessor->check_range_changes(predicted_p_e, prior, epoch);
}

}  // namespace

TEST_CASE("an arc that the filter ends is another from that epoch on, and says why") {
  CarrierPreprocessor preprocessor{CycleSlipConfig()};
  std::vector<SignalObservation> signals;
  MeasurementEpoch epoch;
  for (int t = 0; t < 5; ++t) update_arcs(&preprocessor, t, &signals, &epoch);
  CHECK(epoch.satellites[1].arc == 2);
  CHECK_FALSE(epoch.satellites[1].arc_started);

  preprocessor.end_arc({System::kGps, 2}, &epoch);
  CHECK(epoch.satellites[1].arc == 4);
  CHECK(epoch.satellites[1].arc_started);
  CHECK(epoch.satellites[1].arc_causes.has(SlipCause::kFilter));
  CHECK(epoch.satellites[0].arc == 1);
  CHECK_FALSE(epoch.satellites[0].arc_started);

  update_arcs(&preprocessor, 5, &signals, &epoch);
  CHECK(epoch.satellites[1].arc == 4);
  CHECK(epoch.measurements[1].arc == 4);
  CHECK_FALSE(epoch.satellites[1].arc_started);

  preprocessor.end_arc({System::kGps, 9}, &epoch);  // not seen: nothing happens
  for (const SatelliteInView& view : epoch.satellites) CHECK_FALSE(view.arc_started);
}

TEST_CASE("carriers tell how the antenna has moved, whatever the filter is sure of") {
  CarrierPreprocessor preprocessor{CycleSlipConfig()};
  std::vector<SignalObservation> signals;
  MeasurementEpoch epoch;
  const Eigen::Vector3d start_e(6.4e6, 1.0e5, 2.0e5), step_e(0.02, -0.05, 0.03);
  follow_from(start_e, start_e, 0.0, &preprocessor, &signals, &epoch);
  CHECK_FALSE(preprocessor.antenna_change(RangeChangePrior()));
  preprocessor.store_epoch(epoch, start_e);
  for (int t = 1; t < 4; ++t) {
    follow_from(start_e + t * step_e, start_e, t, &preprocessor, &signals, &epoch);
    const auto change = preprocessor.antenna_change(RangeChangePrior());
    REQUIRE(change);
    CHECK(change->from == kAnyTime.plus_seconds(t - 1));
    CHECK(change->to == epoch.time);
    CHECK((change->change_e - step_e).norm() < 1e-3);
    preprocessor.store_epoch(epoch, start_e + t * step_e);
  }
}

}  // namespace leonav
