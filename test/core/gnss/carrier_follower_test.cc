// What the estimator finds of an arc reaches the arcs and the report.
#include "core/gnss/carrier_follower.h"

#include <vector>

#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2200, 1000.0);

// Three satellites on L1 at rest; fills `epoch` as the preparation of measurements does.
void follow(CarrierFollower* follower, double t, std::vector<SignalObservation>* signals,
            MeasurementEpoch* epoch) {
  signals->clear();
  *epoch = {};
  epoch->time = kStart.plus_seconds(t);
  for (std::uint16_t n = 1; n <= 3; ++n) {
    SignalObservation o;
    o.satellite = {System::kGps, n};
    o.code = {'1', 'C'};
    o.pseudorange_m = 2.2e7;
    o.carrier_cycles = 2.2e7 / wavelength_m(System::kGps, '1');
    o.doppler_hz = 0.0;
    o.lock_time_s = 50.0 + t;
    signals->push_back(o);
  }
  follower->begin(epoch->time);
  for (const SignalObservation& signal : *signals) follower->offer({&signal, nullptr}, 0.8);
  for (const CarrierStatus& status : follower->follow().satellites) {
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
  follower->check_range_changes(Eigen::Vector3d(6.4e6, 0.0, 0.0), RangeChangePrior(), epoch);
}

}  // namespace

TEST_CASE("an arc that the filter ends is another from that epoch on, and says why") {
  CarrierFollower follower{CycleSlipConfig()};
  std::vector<SignalObservation> signals;
  MeasurementEpoch epoch;
  for (int t = 0; t < 5; ++t) follow(&follower, t, &signals, &epoch);
  CHECK(epoch.satellites[1].arc == 2);
  CHECK_FALSE(epoch.satellites[1].arc_started);

  follower.end_arc({System::kGps, 2}, &epoch);
  CHECK(epoch.satellites[1].arc == 4);
  CHECK(epoch.satellites[1].arc_started);
  CHECK(epoch.satellites[1].arc_causes.has(SlipCause::kFilter));
  CHECK(epoch.satellites[0].arc == 1);
  CHECK_FALSE(epoch.satellites[0].arc_started);

  follow(&follower, 5, &signals, &epoch);
  CHECK(epoch.satellites[1].arc == 4);
  CHECK(epoch.measurements[1].arc == 4);
  CHECK_FALSE(epoch.satellites[1].arc_started);

  follower.end_arc({System::kGps, 9}, &epoch);  // not seen: nothing happens
  for (const SatelliteInView& view : epoch.satellites) CHECK_FALSE(view.arc_started);
}

}  // namespace leonav
