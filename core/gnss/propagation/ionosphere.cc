#include "core/gnss/propagation/ionosphere.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

constexpr KlobucharModel kMediumActivity = {{0.1118e-07, -0.7451e-08, -0.5961e-07, 0.1192e-06},
                                            {0.1167e+06, -0.2294e+06, -0.1311e+06, 0.1049e+07},
                                            true};

double cubic(const std::array<double, 4>& k, double x) {
  return k[0] + x * (k[1] + x * (k[2] + x * k[3]));
}

}  // namespace

const KlobucharModel& default_klobuchar() { return kMediumActivity; }

// The names are those of IS-GPS-200 figure 20-4, whose angles are in semicircles.
double klobuchar_delay_m(const KlobucharModel& model, const Geodetic& antenna,
                         const LookAngles& direction, GpsTime time, double frequency_hz) {
  if (!(direction.elevation >= 0.0) || !(frequency_hz > 0.0)) return 0.0;
  const KlobucharModel& used = model.valid ? model : default_klobuchar();

  const double elevation = direction.elevation / kPi;
  const double psi = 0.0137 / (elevation + 0.11) - 0.022;
  const double phi_i =
      std::clamp(antenna.latitude / kPi + psi * std::cos(direction.azimuth), -0.416, 0.416);
  const double lambda_i =
      antenna.longitude / kPi + psi * std::sin(direction.azimuth) / std::cos(phi_i * kPi);
  const double phi_m = phi_i + 0.064 * std::cos((lambda_i - 1.617) * kPi);

  double local_time = 4.32e4 * lambda_i + time.tow_s();
  local_time -= 86400.0 * std::floor(local_time / 86400.0);

  const double amplitude = std::max(cubic(used.alpha, phi_m), 0.0);
  const double period = std::max(cubic(used.beta, phi_m), 72000.0);
  const double x = 2.0 * kPi * (local_time - 50400.0) / period;
  const double slant = 1.0 + 16.0 * std::pow(0.53 - elevation, 3);

  double delay_s = 5e-9;
  if (std::abs(x) < 1.57) delay_s += amplitude * (1.0 - x * x / 2.0 + x * x * x * x / 24.0);
  const double scale = leonav::frequency_hz(System::kGps, '1') / frequency_hz;
  return kSpeedOfLight * slant * delay_s * scale * scale;
}

double zenith_ionosphere_m(const KlobucharModel& model, const Geodetic& antenna, GpsTime time) {
  return klobuchar_delay_m(model, antenna, {.elevation = kPi / 2.0, .azimuth = 0.0}, time,
                           frequency_hz(System::kGps, '1'));
}

}  // namespace leonav
