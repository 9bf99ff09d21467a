// What lies between a measured pseudorange or Doppler and the geometric range model, with its
// uncertainty.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/gnss/antenna_catalog.h"
#include "core/gnss/band_bias.h"
#include "core/gnss/gnss_config.h"
#include "core/gnss/look_angles.h"
#include "core/gnss/measurement.h"
#include "core/gnss/observation.h"

namespace leonav {

// What the delays of one epoch depend on besides the satellite.
struct DelayContext {
  const GnssConfig* config = nullptr;
  const KlobucharModel* klobuchar = nullptr;
  GpsTime time;
  bool has_position = false;  // without one there is no elevation and no atmosphere
  Geodetic antenna;
  const BandBiases* biases = nullptr;  // of the receiver; may be nullptr
  const AntennaCatalog* antennas = nullptr;
  Eigen::Matrix3d C_er =
      Eigen::Matrix3d::Identity();  // receiver antenna's axes, forward-right-down
  Eigen::Vector3d p_sun_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d tide_e =
      Eigen::Vector3d::Zero();  // of the ground under the antenna, all tides, m
};

// At `p_a_e`, or zero if unknown; the antenna's axes north, east, down.
DelayContext delay_context(const GnssConfig& config, const KlobucharModel& klobuchar, GpsTime time,
                           const Eigen::Vector3d& p_a_e);

// 1 sigma of all that stays uncorrected while no position is known: atmosphere down to the horizon.
inline constexpr double kUnknownAtmosphereSigma = 15.0;  // m

// Fills elevation, azimuth and the troposphere's delay of `satellite`.
void correct_direction(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                       SatelliteInView* satellite);

// Code of one signal, or (`second` given) of the ionosphere-free pair, ready for the model.
// `broadcast` tells the group delays and may be nullptr. `shared_by`: as many single-frequency
// measurements of the same satellite are used together; their ionospheric errors are the same, so
// each variance is multiplied by their number, which leaves the weight of one in the sum.
// For a single frequency satellite->ionosphere_l1_m is set.
Measurement code_measurement(const DelayContext& context, const SignalObservation& first,
                             const SignalObservation* second, const Ephemeris* broadcast,
                             int shared_by, SatelliteInView* satellite);

// Doppler of one signal, or the ionosphere-free combination of two.
Measurement doppler_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const SatelliteInView& satellite);

}  // namespace leonav
