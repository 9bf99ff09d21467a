// How the noise of an observable grows with low elevation, weak signal and combination.
#pragma once
#include "core/gnss/gnss_config.h"

namespace leonav {

// Elevation at and above which an observable has its zenith noise.
inline constexpr double kFullWeightElevation = 0.5235987755982988;  // rad (30 degrees)

// Factor on sigma0: 1 from 30 degrees up, 1 / (2 sin E) below (Remote Sensing 2024 eq. 35),
// continuous at 30 degrees; bounded at the value for 1 degree.
double elevation_factor(double elevation);

// 1 / sin E up to the zenith: how codes and carriers of a geodetic antenna scatter (measured on the
// station recording, docs/models.md); bounded likewise.
double sine_factor(double elevation);

// Factor on sigma0 for one signal. kCn0: the larger of the elevation's factor and
// 10^((reference - C/N0) / 20); a signal without C/N0 (NaN) gets the elevation's factor.
// `elevation` unknown (no position yet): pass pi/2.
double noise_factor(const GnssConfig& config, double elevation, double cn0_dbhz);

// Two frequencies combined so that the first-order ionosphere cancels:
//   value = gamma1 * first + gamma2 * second, gamma1 + gamma2 = 1.
struct IonosphereFree {
  double gamma1 = 1.0;
  double gamma2 = 0.0;
};
// Frequencies in Hz, different and positive.
IonosphereFree ionosphere_free(double frequency1_hz, double frequency2_hz);

// 1 sigma of the combination of two independent observables.
double combined_sigma(const IonosphereFree& combination, double sigma1, double sigma2);

}  // namespace leonav
