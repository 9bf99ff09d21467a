// Which carriers are followed while signals come and go.
#include "core/gnss/preprocessing/internal/carrier_selection.h"

#include <vector>

#include "core/gnss/preprocessing/carrier_preprocessor.h"
#include "support/catch.h"
#include "support/start_time.h"

namespace leonav {
namespace {

using test::kAnyTime;

const SatelliteId kSatellite{System::kGps, 7};

SignalObservation signal_of(SignalCode code, bool with_code = true, bool with_carrier = true) {
  SignalObservation o;
  o.satellite = kSatellite;
  o.code = code;
  if (with_code) o.pseudorange_m = 2.2e7;
  if (with_carrier) o.carrier_cycles = 2.2e7 / wavelength_m(System::kGps, code.band);
  o.cn0_dbhz = 40.0f;
  return o;
}

// The arc that a satellite with these signals has at `t`; 0: no carrier.
std::uint32_t arc_of(CarrierPreprocessor* preprocessor, double t,
                     const std::vector<SignalObservation>& signals) {
  const SelectedSignals selected =
      select_signals({signals.data(), signals.size()}, SignalPreference(), 20.0);
  preprocessor->begin(kAnyTime.plus_seconds(t));
  preprocessor->set_wind_up(kSatellite, 0.0);
  const CarrierChoice choice = choose_carriers({signals.data(), signals.size()}, selected, 20.0,
                                               preprocessor->tracked_pair(kSatellite));
  if (choice.first != nullptr) preprocessor->add_carrier(choice, 0.8);
  const ArcEpoch& arcs = preprocessor->update_arcs();
  return arcs.satellites.empty() ? 0 : arcs.satellites[0].arc;
}

}  // namespace

TEST_CASE("a pair's arc outlives its codes, and for a while its carriers") {
  constexpr SignalCode k1C{'1', 'C'}, k2W{'2', 'W'};
  const std::vector<SignalObservation> both = {signal_of(k1C), signal_of(k2W)};
  CarrierPreprocessor preprocessor{CycleSlipConfig()};
  CHECK(arc_of(&preprocessor, 0, both) == 1);
  CHECK(arc_of(&preprocessor, 1, both) == 1);
  // Without the second's code, the first's, both.
  CHECK(arc_of(&preprocessor, 2, {signal_of(k1C), signal_of(k2W, false)}) == 1);
  CHECK(arc_of(&preprocessor, 3, {signal_of(k1C, false), signal_of(k2W)}) == 1);
  // Without one of the carriers: none, and no other arc.
  CHECK(arc_of(&preprocessor, 4, {signal_of(k1C)}) == 0);
  CHECK(arc_of(&preprocessor, 5, {signal_of(k1C), signal_of(k2W, true, false)}) == 0);
  CHECK(arc_of(&preprocessor, 6, both) == 1);
  // Another signal on a band is another ambiguity: it waits.
  CHECK(arc_of(&preprocessor, 7, {signal_of({'1', 'W'}), signal_of(k2W)}) == 0);
  // A second carrier below the C/N0 mask is none.
  std::vector<SignalObservation> weak = both;
  weak[1].cn0_dbhz = 10.0f;
  CHECK(arc_of(&preprocessor, 8, weak) == 0);
  CHECK(arc_of(&preprocessor, 9, both) == 1);
  // Gone for longer than an arc lasts: the first alone is followed.
  for (int t = 10; t <= 19; ++t) CHECK(arc_of(&preprocessor, t, {signal_of(k1C)}) == 0);
  CHECK(arc_of(&preprocessor, 20, {signal_of(k1C)}) == 2);
  CHECK(arc_of(&preprocessor, 21, {signal_of(k1C)}) == 2);
  // A second frequency that comes makes a pair of it at once.
  CHECK(arc_of(&preprocessor, 22, both) == 3);
}

}  // namespace leonav
