// What of the sky is used, and how it is weighted.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <optional>

#include "core/earth/tides.h"
#include "core/gnss/cycle_slip_config.h"
#include "core/gnss/satellite_attitude.h"
#include "core/gnss/satellite_catalog.h"
#include "core/gnss/signal.h"

namespace leonav {

enum class CodeCombination : unsigned char {
  kIonosphereFree,   // two frequencies where there are two, else one with Klobuchar
  kSingleFrequency,  // every usable signal by itself, ionosphere by Klobuchar
};

// Preferred signals of a system: bands in order of preference, attributes in order within a band.
struct SignalPreference {
  char first_band = 0;                                    // e.g. '1'
  boost::container::static_vector<char, 3> second_bands;  // e.g. {'2', '5'}
  // Attributes tried in this order for every band; empty: RINEX alphabetical order.
  boost::container::static_vector<char, 12> attributes;
};

struct ObservableSigma {
  double code_m = 1.0;  // one frequency, at zenith
  // On the code of 5 and 10 MHz chipping rate (GPS L5, Galileo E5/E6, BeiDou B2a/B2b/B3I).
  double wideband_code_factor = 0.5;
  double carrier_m = 0.003;
  double doppler_m_s = 0.1;
};

struct SystemConfig {
  bool enabled = false;
  // Cap, highest elevations first, of a filter under way; 0: none.
  int max_satellites = 0;
  SignalPreference signals;
  ObservableSigma sigma;
};

enum class WeightModel : unsigned char {
  kElevation,  // sigma0 above 30 degrees, sigma0 / (2 sin E) below (Remote Sensing 2024 eq. 35)
  kCn0,        // variance scaled by 10^((cn0_reference - C/N0) / 10), at least the elevation's
  kSine,       // sigma0 / sin E: geodetic antennas
};

struct GnssConfig {
  std::array<SystemConfig, kSystemCount> systems;
  double elevation_mask = 0.2617993877991494;  // rad (15 degrees)
  double cn0_mask_dbhz = 0.0;
  CodeCombination code_combination = CodeCombination::kIonosphereFree;
  WeightModel weight_model = WeightModel::kElevation;
  double cn0_reference_dbhz = 45.0;        // C/N0 at which the sigmas hold (kCn0)
  double ionosphere_model_error = 0.5;     // share of the Klobuchar delay taken as its 1 sigma
  double troposphere_model_error_m = 0.1;  // 1 sigma at zenith
  // How LEO satellites stand, for antennas and wind-up; the others' laws are known.
  AttitudeLaw leo_attitude = AttitudeLaw::kOrbitNormal;
  // How the ground moves besides the solid Earth tide; not known: not applied.
  std::optional<OceanLoading> ocean_loading;  // of where the receiver is
  std::optional<PolarMotion> polar_motion;
  CatalogOptions catalog;
  CycleSlipConfig cycle_slips;
};

// The defaults of the design: GPS L1+L2 (L5 where L2 is missing), Galileo E1+E5a, BeiDou B1I+B3I,
// LEO L1+L2.
GnssConfig default_gnss_config();

}  // namespace leonav
