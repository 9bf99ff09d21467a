#include "core/gnss/measurement/transmission_state.h"

#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

// The clock only shifts the instant: two look-ups reduce 1 ms of satellite clock to below a
// nanosecond.
LookupStatus state_at_transmission(const EphemerisStore& ephemeris_store, SatelliteId id,
                                   GpsTime by_satellite_clock, SatelliteState* state,
                                   const Ephemeris** ephemeris) {
  LookupStatus status = ephemeris_store.state_at(id, by_satellite_clock, state, ephemeris);
  if (status != LookupStatus::kOk) return status;
  if (!std::isfinite(state->clock_s)) return LookupStatus::kNoEphemeris;  // orbit without clock
  const GpsTime transmission = by_satellite_clock.plus_seconds(-state->clock_s);
  return ephemeris_store.state_at(id, transmission, state, ephemeris);
}

}  // namespace

LookupStatus satellite_at_transmission(const EphemerisStore& ephemeris_store, GpsTime time_tag,
                                       double pseudorange_m, const Eigen::Vector3d& p_a_e,
                                       SatelliteInView* satellite, const Ephemeris** broadcast) {
  SatelliteState state;
  const Ephemeris* ephemeris = nullptr;
  const GpsTime sent = time_tag.plus_seconds(-pseudorange_m / kSpeedOfLight);
  const LookupStatus status =
      state_at_transmission(ephemeris_store, satellite->satellite, sent, &state, &ephemeris);
  if (status != LookupStatus::kOk) return status;
  if (ephemeris == nullptr) ephemeris = ephemeris_store.ephemeris_at(satellite->satellite, sent);

  // The Earth turned during the flight: the ECEF frame of reception is ahead by this angle.
  double flight_time = pseudorange_m / kSpeedOfLight;
  if (!p_a_e.isZero()) {
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d p = rotate_about_z(state.p_e, kEarthRotationRate * flight_time);
      flight_time = (p - p_a_e).norm() / kSpeedOfLight;
    }
  }
  const double angle = kEarthRotationRate * flight_time;
  satellite->p_e = rotate_about_z(state.p_e, angle);
  satellite->v_e = rotate_about_z(state.v_e, angle);
  satellite->clock_m = kSpeedOfLight * state.clock_s;
  satellite->clock_drift_m_s = kSpeedOfLight * state.clock_drift;
  satellite->orbit_sigma_m = state.sigma_m;
  satellite->orbit_sigma_change_m = state.sigma_change_m;
  satellite->orbit_issue = state.issue;
  satellite->ephemeris_age_s = state.age_s;
  satellite->source = state.source;
  satellite->at_antenna = state.at_antenna;
  satellite->clock_from_file = state.clock_from_file;
  *broadcast = ephemeris;
  return LookupStatus::kOk;
}

}  // namespace leonav
