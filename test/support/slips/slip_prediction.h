// What a satellite's carrier should read, from its orbit and clock as they were known at the time.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/preprocessing/internal/carrier_correction.h"
#include "core/gnss/propagation/troposphere.h"

namespace leonav::test {

// Where a satellite is seen from, and what its carrier should read but for ambiguity, receiver
// clock and ionosphere.
struct Prediction {
  double range_m = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // d range / d antenna position
  double elevation = 0.0;
  std::uint32_t issue = 0;            // as in SatelliteState
  std::optional<Ephemeris> elements;  // of a broadcast orbit
  GpsTime sent;
  Eigen::Vector3d antenna_p_e = Eigen::Vector3d::Zero();
};

inline Prediction predicted_range(const SatelliteState& state, double flight_s,
                                  const Eigen::Vector3d& p_e, GpsTime time) {
  const double turn = kEarthRotationRate * flight_s;
  Eigen::Vector3d p_s = state.p_e;
  p_s.x() = std::cos(turn) * state.p_e.x() + std::sin(turn) * state.p_e.y();
  p_s.y() = -std::sin(turn) * state.p_e.x() + std::cos(turn) * state.p_e.y();
  Prediction prediction;
  const Eigen::Vector3d line = p_s - p_e;
  prediction.elevation = look_angles(p_s, p_e).elevation;
  prediction.direction = -line.normalized();
  prediction.range_m =
      line.norm() - kSpeedOfLight * state.clock_s +
      saastamoinen_slant_delay_m(to_geodetic(p_e), std::max(prediction.elevation, 0.05), time);
  return prediction;
}

// From an ephemeris store as of now and the tag and pseudorange, whose errors in the receiver's
// clock cancel.
inline std::optional<Prediction> predict_by_catalog(const EphemerisStore& ephemeris_store,
                                                    SatelliteId id, GpsTime tag,
                                                    double pseudorange_m,
                                                    const Eigen::Vector3d& p_e) {
  SatelliteState state;
  const Ephemeris* ephemeris = nullptr;
  if (!std::isfinite(pseudorange_m)) return std::nullopt;
  double sent_s = -pseudorange_m / kSpeedOfLight;  // after the tag, by the satellite's clock
  if (ephemeris_store.state_at(id, tag.plus_seconds(sent_s), &state) != LookupStatus::kOk) {
    return std::nullopt;
  }
  sent_s -= state.clock_s;
  const GpsTime sent = tag.plus_seconds(sent_s);
  if (ephemeris_store.state_at(id, sent, &state, &ephemeris) != LookupStatus::kOk)
    return std::nullopt;
  // What a time in whole nanoseconds leaves out.
  state.p_e += state.v_e * (sent_s - seconds_between(sent, tag));
  double flight_s = (state.p_e - p_e).norm() / kSpeedOfLight;
  Prediction prediction = predicted_range(state, flight_s, p_e, tag);
  prediction.issue = state.issue;
  if (ephemeris != nullptr) prediction.elements = *ephemeris;
  prediction.sent = sent;
  prediction.antenna_p_e = p_e;
  return prediction;
}

}  // namespace leonav::test
