// This unit corrects a measured pseudorange or Doppler to the geometric range model and computes
// its uncertainty.
#pragma once
#include <span>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/preprocessing/receiver_code_bias.h"
#include "core/gnss/propagation/antenna_pattern_store.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// Inputs of the delays of one epoch other than the satellite.
struct DelayContext {
  const GnssConfig* config = nullptr;
  const KlobucharModel* klobuchar = nullptr;
  std::uint32_t klobuchar_issue = 0;  // EphemerisStore::klobuchar_issue()
  GpsTime time;
  bool has_position = false;  // without one there is no elevation and no atmosphere
  Geodetic antenna;
  const ReceiverCodeBiases* biases = nullptr;  // of the receiver; may be nullptr
  const AntennaPatternStore* antennas = nullptr;
  const SignalBiasStore* signal_biases = nullptr;  // of satellites; may be nullptr
  Eigen::Matrix3d C_er =
      Eigen::Matrix3d::Identity();  // receiver antenna's axes, forward-right-down
  Eigen::Vector3d p_sun_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d tide_e =
      Eigen::Vector3d::Zero();  // of the ground under the antenna, all tides, m
};

// Builds the context at `p_a_e` (ECEF, m), or zero if unknown, with the antenna's axes north, east,
// down.
DelayContext delay_context(const GnssConfig& config, const KlobucharModel& klobuchar, GpsTime time,
                           const Eigen::Vector3d& p_a_e);

// 1 sigma of all uncorrected errors while no position is known: the atmosphere down to the horizon.
inline constexpr double kUnknownAtmosphereSigma = 15.0;  // m

// Returns the ionosphere's delay on a frequency (Hz) over that on L1.
double ionosphere_factor(double frequency);
// Returns the length of a path in the ionosphere over the vertical one, in a shell at 350 km:
//   1 / cos z',  sin z' = 6371/6721 cos E,  E: `elevation` (rad).
double ionosphere_slant(double elevation);

// Returns the ionosphere's delay of a code on `frequency` (Hz) by the broadcast model, m; 0 where
// there is no atmosphere. Precondition: context.has_position.
double ionosphere_delay_m(const DelayContext& context, const SatelliteInView& satellite,
                          double frequency);

// Sets elevation, azimuth and tropospheric delay of `satellite`.
void set_look_angles_and_troposphere(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                                     SatelliteInView* satellite);

// Corrects the code of one signal or, with `second`, of the ionosphere-free pair. `broadcast` has
// the group delays and may be nullptr. `shared_by` is the number of single-frequency measurements
// of the satellite that are used together: their ionospheric errors are the same, so each variance
// is multiplied by their number, which leaves the weight of one in the sum. For a single frequency
// satellite->ionosphere_l1_m is set.
Measurement code_measurement(const DelayContext& context, const SignalObservation& first,
                             const SignalObservation* second, const Ephemeris* broadcast,
                             int shared_by, SatelliteInView* satellite);

// Returns the variances of the satellite's code as the pair of `bands.front()` and `second`, and as
// the single frequencies of `bands`, which are sorted best first; zeros without a position.
CodeVariances code_variances(const DelayContext& context,
                             std::span<const SignalObservation* const> bands,
                             const SignalObservation& second, const SatelliteInView& satellite);

// Corrects the Doppler of one signal, or the ionosphere-free combination of two.
Measurement doppler_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const SatelliteInView& satellite);

}  // namespace leonav
