#include "core/gnss/propagation/troposphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/angle.h"

namespace leonav {
namespace {

constexpr double kLowestHeight = -500.0;     // m
constexpr double kHighestHeight = 11'000.0;  // m, above which the standard atmosphere is isothermal

double clamped_height(const Geodetic& antenna) {
  return std::clamp(antenna.height, kLowestHeight, kHighestHeight);
}

// Coefficients a, b, c of the continued fraction.
using Fraction = std::array<double, 3>;

// Niell (1996) tables 3 and 4 at 15, 30, 45, 60, 75 degrees of latitude.
constexpr std::array<Fraction, 5> kHydrostaticAverage = {
    Fraction{1.2769934e-3, 2.9153695e-3, 62.610505e-3},
    Fraction{1.2683230e-3, 2.9152299e-3, 62.837393e-3},
    Fraction{1.2465397e-3, 2.9288445e-3, 63.721774e-3},
    Fraction{1.2196049e-3, 2.9022565e-3, 63.824265e-3},
    Fraction{1.2045996e-3, 2.9024912e-3, 64.258455e-3}};
constexpr std::array<Fraction, 5> kHydrostaticAmplitude = {
    Fraction{0.0, 0.0, 0.0}, Fraction{1.2709626e-5, 2.1414979e-5, 9.0128400e-5},
    Fraction{2.6523662e-5, 3.0160779e-5, 4.3497037e-5},
    Fraction{3.4000452e-5, 7.2562722e-5, 84.795348e-5},
    Fraction{4.1202191e-5, 11.723375e-5, 170.37206e-5}};
constexpr std::array<Fraction, 5> kWet = {Fraction{5.8021897e-4, 1.4275268e-3, 4.3472961e-2},
                                          Fraction{5.6794847e-4, 1.5138625e-3, 4.6729510e-2},
                                          Fraction{5.8118019e-4, 1.4572752e-3, 4.3908931e-2},
                                          Fraction{5.9727542e-4, 1.5007428e-3, 4.4626982e-2},
                                          Fraction{6.1641693e-4, 1.7599082e-3, 5.4736038e-2}};
constexpr Fraction kHeightCorrection = {2.53e-5, 5.49e-3, 1.14e-3};

Fraction at_latitude(const std::array<Fraction, 5>& table, double latitude_deg) {
  const double table_position = std::clamp(latitude_deg / 15.0 - 1.0, 0.0, 4.0);
  const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(table_position), 3);
  const double share = table_position - static_cast<double>(below);
  Fraction result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = table[below][i] * (1.0 - share) + table[below + 1][i] * share;
  }
  return result;
}

// Marini's continued fraction, normalized to one at zenith (Niell 1996, eq. 4).
double marini(double sine, const Fraction& k) {
  const double at_zenith = 1.0 + k[0] / (1.0 + k[1] / (1.0 + k[2]));
  return at_zenith / (sine + k[0] / (sine + k[1] / (sine + k[2])));
}

// Returns the cosine of the season: 1 on 28 January in the north, on 29 July in the south (Niell
// 1996, eq. 5).
double season(GpsTime time, double latitude) {
  // 1980-01-06 is day 6 of its year; counting whole Julian years stays within a day of the day of
  // year.
  const double days = static_cast<double>(time.nanoseconds()) * 1e-9 / 86400.0 + 6.0;
  const double half_year = latitude < 0.0 ? 0.5 : 0.0;
  return std::cos(2.0 * std::numbers::pi * ((days - 28.0) / 365.25 + half_year));
}

}  // namespace

ZenithDelays saastamoinen_zenith_delays(const Geodetic& antenna, double relative_humidity) {
  const double height = clamped_height(antenna);
  // ICAO standard atmosphere, 15 degC and 1013.25 hPa at sea level, -6.5 K per kilometre.
  const double temperature = 288.15 - 6.5e-3 * height;
  const double pressure = 1013.25 * std::pow(1.0 - 2.25577e-5 * height, 5.2559);
  // Partial pressure of water vapour, hPa: saturation pressure after Murray (1967) times humidity.
  const double vapour =
      relative_humidity * 6.108 * std::exp(17.15 * (temperature - 273.15) / (temperature - 38.45));
  // Davis et al. (1985) eq. A11: the dependence of gravity on latitude and height.
  const double gravity = 1.0 - 0.00266 * std::cos(2.0 * antenna.latitude) - 0.28e-6 * height;
  ZenithDelays delays;
  delays.hydrostatic_m = 0.0022768 * pressure / gravity;
  delays.wet_m = 0.002277 * (1255.0 / temperature + 0.05) * vapour;
  return delays;
}

TroposphereMapping niell_mapping(const Geodetic& antenna, double elevation, GpsTime time) {
  const double sine =
      std::sin(std::clamp(elevation, 1.0 / kDegreesPerRadian, std::numbers::pi / 2.0));
  const double latitude_deg = std::abs(antenna.latitude) * kDegreesPerRadian;

  Fraction hydrostatic = at_latitude(kHydrostaticAverage, latitude_deg);
  if (time.is_set()) {
    const Fraction amplitude = at_latitude(kHydrostaticAmplitude, latitude_deg);
    const double cosine = season(time, antenna.latitude);
    for (std::size_t i = 0; i < hydrostatic.size(); ++i) hydrostatic[i] -= amplitude[i] * cosine;
  }
  // Niell (1996) eq. 6: the height correction is per kilometre.
  const double correction = 1.0 / sine - marini(sine, kHeightCorrection);

  TroposphereMapping mapping;
  mapping.hydrostatic = marini(sine, hydrostatic) + correction * clamped_height(antenna) * 1e-3;
  mapping.wet = marini(sine, at_latitude(kWet, latitude_deg));
  return mapping;
}

double saastamoinen_slant_delay_m(const Geodetic& antenna, double elevation, GpsTime time) {
  const ZenithDelays zenith = saastamoinen_zenith_delays(antenna);
  const TroposphereMapping mapping = niell_mapping(antenna, elevation, time);
  return zenith.hydrostatic_m * mapping.hydrostatic + zenith.wet_m * mapping.wet;
}

}  // namespace leonav
