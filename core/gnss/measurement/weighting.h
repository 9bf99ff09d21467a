// This unit models how the noise of an observable grows with low elevation, weak signal and
// combination.
#pragma once
#include "core/gnss/measurement/gnss_config.h"

namespace leonav {

// At and above this elevation an observable has its zenith noise.
inline constexpr double kFullWeightElevation = 0.5235987755982988;  // rad (30 degrees)

// Returns the factor on sigma0 for elevation E (rad): 1 from 30 degrees up, 1 / (2 sin E) below
// (Remote Sensing 2024 eq. 35). It is continuous at 30 degrees and bounded at the value for 1
// degree.
double elevation_factor(double elevation);

// Returns the factor 1 / sin E up to the zenith, by which codes and carriers of a geodetic antenna
// scatter (measured on the station recording, docs/validation/preprocessing.md). It is bounded at
// the value for 1 degree.
double sine_factor(double elevation);

// Returns the factor on sigma0 for one signal. With kCn0 it is the larger of the elevation's factor
// and 10^((reference - C/N0) / 20); a signal without C/N0 (NaN) gets the elevation's factor. Where
// the elevation is unknown (no position yet), pass pi/2.
double noise_factor(const GnssConfig& config, double elevation, double cn0_dbhz);

// Combination of two frequencies in which the first-order ionosphere cancels:
//   value = gamma1 * first + gamma2 * second, gamma1 + gamma2 = 1.
struct IonosphereFree {
  double gamma1 = 1.0;
  double gamma2 = 0.0;
};
// Computes the coefficients for frequencies in Hz, which must be different and positive.
IonosphereFree ionosphere_free(double frequency1_hz, double frequency2_hz);

// Returns 1 sigma of the combination of two independent observables.
double combined_sigma(const IonosphereFree& combination, double sigma1, double sigma2);

}  // namespace leonav
