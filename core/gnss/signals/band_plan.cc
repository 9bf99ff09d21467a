#include "core/gnss/signals/band_plan.h"

#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

bool is_leo_band(char band) { return band >= BandPlan::kFirstBand && band <= BandPlan::kLastBand; }

}  // namespace

BandPlan::BandPlan() {
  set_leo('1', leonav::frequency_hz(System::kGps, '1'));
  set_leo('2', leonav::frequency_hz(System::kGps, '2'));
}

void BandPlan::set_leo(char band, double frequency_hz) {
  if (is_leo_band(band)) leo_hz_[static_cast<std::size_t>(band - kFirstBand)] = frequency_hz;
}

double BandPlan::frequency_hz(System system, char band) const {
  if (system != System::kLeo) return leonav::frequency_hz(system, band);
  return is_leo_band(band) ? leo_hz_[static_cast<std::size_t>(band - kFirstBand)] : 0.0;
}

double BandPlan::wavelength_m(System system, char band) const {
  const double frequency = frequency_hz(system, band);
  return frequency > 0.0 ? kSpeedOfLight / frequency : 0.0;
}

bool is_band_of(System system, char band) {
  return system == System::kLeo ? is_leo_band(band) : frequency_hz(system, band) > 0.0;
}

}  // namespace leonav
