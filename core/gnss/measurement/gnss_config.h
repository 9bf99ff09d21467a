// This header configures which satellites and signals are used, and how they are weighted.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <optional>

#include "core/earth/tides.h"
#include "core/gnss/measurement/cycle_slip_config.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Choice of the codes that enter the estimators.
enum class CodeCombination : unsigned char {
  kIonosphereFree,   // a pair where two frequencies exist, else one with Klobuchar
  kSingleFrequency,  // every usable signal by itself, ionosphere by Klobuchar
  // Pairs, and single frequencies while the navigator finds that pairs are the less accurate ones:
  // core/navigator/monitors/code_combination_monitor.h.
  kAutomatic,
};

// Preferred signals of a system: bands in order of preference, and the attributes within a band.
struct SignalPreference {
  char first_band = 0;                                    // e.g. '1'
  boost::container::static_vector<char, 3> second_bands;  // e.g. {'2', '5'}
  // Attributes are tried in this order in every band; empty: RINEX alphabetical order.
  boost::container::static_vector<char, 12> attributes;

  bool operator==(const SignalPreference&) const = default;
};

// 1 sigma of the noise of each observable.
struct ObservableSigma {
  double code_m = 1.0;  // one frequency, at zenith
  // Factor on code_m for a chipping rate of 5 or 10 MHz (GPS L5, Galileo E5/E6, BeiDou
  // B2a/B2b/B3I).
  double wideband_code_factor = 0.5;
  double carrier_m = 0.003;
  double doppler_m_s = 0.1;

  bool operator==(const ObservableSigma&) const = default;
};

// Settings of one satellite system.
struct SystemConfig {
  bool enabled = false;
  // Largest number of satellites of a running filter, highest elevations first; 0: no limit.
  int max_satellites = 0;
  SignalPreference signals;
  ObservableSigma sigma;

  bool operator==(const SystemConfig&) const = default;
};

// Model of the noise by elevation or C/N0.
enum class WeightModel : unsigned char {
  // Sigma0 above 30 degrees, sigma0 / (2 sin E) below (Remote Sensing 2024, 16, 1782, eq. 35).
  kElevation,
  kCn0,   // variance scaled by 10^((cn0_reference - C/N0) / 10), at least the elevation's
  kSine,  // sigma0 / sin E: geodetic antennas
};

// Settings of the whole chapter core/gnss.
struct GnssConfig {
  std::array<SystemConfig, kSystemCount> systems;
  BandPlan bands;                              // carriers; of LEO satellites as configured
  double elevation_mask = 0.2617993877991494;  // rad (15 degrees)
  double cn0_mask_dbhz = 0.0;
  CodeCombination code_combination = CodeCombination::kAutomatic;
  WeightModel weight_model = WeightModel::kElevation;
  double cn0_reference_dbhz = 45.0;  // C/N0 at which the sigmas hold (kCn0)
  // Whether ionosphere and troposphere delay the signals; false for those of a simulator without
  // them.
  bool has_atmosphere = true;
  double ionosphere_model_error = 0.5;     // share of the Klobuchar delay taken as its 1 sigma
  double troposphere_model_error_m = 0.1;  // 1 sigma at zenith
  // Attitude law of LEO satellites, for antennas and wind-up; the laws of the others are fixed.
  AttitudeLaw leo_attitude = AttitudeLaw::kOrbitNormal;
  // Motion of the ground beside the solid Earth tide; unset: not applied.
  std::optional<OceanLoading> ocean_loading;  // at the receiver's position
  std::optional<PolarMotion> polar_motion;
  EphemerisConfig ephemeris_store;
  CycleSlipConfig cycle_slips;

  bool operator==(const GnssConfig&) const = default;
};

// Returns the defaults: GPS L1+L2 (L5 where L2 is missing), Galileo E1+E5a, BeiDou B1I+B3I, LEO
// L1+L2.
GnssConfig default_gnss_config();

}  // namespace leonav
