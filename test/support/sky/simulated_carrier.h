// Carrier phases for simulated epochs: integer ambiguities, wind-up, noise, and slips on demand.
#pragma once
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/propagation/phase_wind_up.h"
#include "core/gnss/signals/band_plan.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {

class SimulatedCarriers {
 public:
  SimulatedCarriers(double sigma_m, double slip_probability, std::uint64_t seed)
      : sigma_m_(sigma_m), slip_probability_(slip_probability), generator_(seed) {}

  AttitudeLaw leo_attitude = AttitudeLaw::kOrbitNormal;

  // Fills the carriers of `raw`, whose codes must still be free of noise. `C_er`: axes of the
  // receiver's antenna, forward, right, down.
  void fill(const SimulatedSky& sky, const SimulatedReceiver& receiver, double t,
            const Eigen::Matrix3d& C_er, RawEpoch* raw) {
    const Eigen::Vector3d p_a = receiver.p_e + receiver.v_e * t;
    const GpsTime now = kSkyEpoch.plus_seconds(t);
    const Eigen::Vector3d sun_e = sun_moon_positions(now).sun_e;
    SatelliteId last;
    for (SignalObservation& o : raw->observations) {
      Arc& arc = arcs_[{o.satellite, o.code.band}];
      if (!arc.known) arc = {true, std::round(1e6 * normal_(generator_)), 0.0};
      // The band that is used by default.
      const bool first =
          o.satellite.system == System::kBeidou ? o.code.band == '2' : !(o.satellite == last);
      last = o.satellite;
      if (first && slip_probability_ > 0.0 && uniform_(generator_) < slip_probability_) {
        arc.cycles += std::round(1.0 + 100.0 * uniform_(generator_));
        ++slips_;
      }
      const Ephemeris& e = ephemeris_of(sky, o.satellite);
      const SatelliteState state = broadcast_state(e, now.plus_seconds(-0.07));
      const Eigen::Matrix3d C_es =
          satellite_axes(state.p_e, state.v_e, sun_e, attitude_law(o.satellite, leo_attitude));
      arc.wind_up = phase_wind_up_cycles(state.p_e, C_es, p_a, C_er, arc.wind_up);
      const double frequency = BandPlan().frequency_hz(o.satellite.system, o.code.band);
      const double wavelength = kSpeedOfLight / frequency;
      double ionosphere = 0.0;
      if (receiver.atmosphere) {
        ionosphere = klobuchar_delay_m(sky.ephemeris_store.klobuchar(), to_geodetic(p_a),
                                       look_angles(state.p_e, p_a), now, frequency);
      }
      o.carrier_cycles =
          (o.pseudorange_m - 2.0 * ionosphere + sigma_m_ * normal_(generator_)) / wavelength +
          arc.wind_up + arc.cycles;
      o.lock_time_s = 1000.0;
    }
  }
  int slips() const { return slips_; }

 private:
  struct Arc {
    bool known = false;
    double cycles = 0.0, wind_up = 0.0;
  };
  static const Ephemeris& ephemeris_of(const SimulatedSky& sky, SatelliteId id) {
    return *std::find_if(sky.ephemerides.begin(), sky.ephemerides.end(),
                         [&](const Ephemeris& e) { return e.satellite == id; });
  }

  double sigma_m_, slip_probability_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  std::map<std::pair<SatelliteId, char>, Arc> arcs_;
  int slips_ = 0;
};

}  // namespace leonav::test
