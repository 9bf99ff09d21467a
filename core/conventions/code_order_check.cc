#include "core/conventions/code_order_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/gnss/group_delay.h"

namespace leonav {
namespace {

constexpr double kShellShare = 0.94;    // of the Earth's radius to that of a shell at 400 km
constexpr double kMinElevation = 0.17;  // rad
constexpr float kMinEpochs = 20.0F;
constexpr int kMinSatellites = 8, kMinOfSystem = 3;
constexpr double kClear = 5.0;  // sigmas
constexpr double kMin_m = 0.5;  // at zenith, on L1: the quietest night has about that

// At the zenith 1, near the horizon some 2.5: slant of the path through a thin shell.
double slant_of(double elevation) {
  const double sine = kShellShare * std::cos(elevation);
  return 1.0 / std::sqrt(1.0 - sine * sine);
}

double corrected_m(const SignalObservation& observation, const Ephemeris* elements) {
  if (elements == nullptr) return observation.pseudorange_m;
  return observation.pseudorange_m - group_delay(*elements, observation.code).delay_m;
}

// The delay on L1 that two codes tell.
std::optional<double> delay_m(const SignalObservation& first, const SignalObservation& second,
                              const Ephemeris* elements) {
  const System system = first.satellite.system;
  const double f1 = frequency_hz(system, first.code.band);
  const double f2 = frequency_hz(system, second.code.band);
  const double fl1 = frequency_hz(System::kGps, '1');
  if (!(f1 > 0.0) || !(f2 > 0.0)) return std::nullopt;
  const double share = fl1 * fl1 * (1.0 / (f2 * f2) - 1.0 / (f1 * f1));
  // Too near to each other, they tell noise.
  if (!(std::abs(share) > 0.2)) return std::nullopt;
  const double delay = (corrected_m(second, elements) - corrected_m(first, elements)) / share;
  return std::isfinite(delay) && std::abs(delay) < 200.0 ? std::optional(delay) : std::nullopt;
}

// A straight line through the satellites' means, each system with a constant of its own.
struct Line {
  int satellites = 0, systems = 0;
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

}  // namespace

void CodeOrderCheck::add(const RawEpoch& epoch, const MeasurementEpoch& seen,
                         const SatelliteCatalog& catalog) {
  const auto& all = epoch.observations;
  for (const SatelliteInView& satellite : seen.satellites) {
    if (!is_valid(satellite.satellite) || !(satellite.elevation > kMinElevation)) continue;
    const SignalObservation *first = nullptr, *second = nullptr;
    for (const SignalObservation& observation : all) {
      if (observation.satellite != satellite.satellite) continue;
      if (!std::isfinite(observation.pseudorange_m)) continue;
      if (first == nullptr) first = &observation;
      if (observation.code.band == first->code.band) continue;
      second = &observation;
      break;
    }
    if (second == nullptr) continue;
    const Ephemeris* elements = satellite.satellite.system == System::kLeo
                                    ? nullptr
                                    : catalog.ephemeris_at(satellite.satellite, epoch.time);
    const auto delay = delay_m(*first, *second, elements);
    if (!delay) continue;
    Mean& mean = satellites_[place_of(satellite.satellite)];
    mean.n += 1.0F;
    mean.slant += static_cast<float>(slant_of(satellite.elevation));
    mean.delay_m += static_cast<float>(*delay);
  }
}

ConventionFinding CodeOrderCheck::judge() const {
  Line line;
  std::size_t place = 0;
  for (const std::uint16_t highest : kHighestNumber) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = place; i < place + highest; ++i) {
      const Mean& mean = satellites_[i];
      if (mean.n < kMinEpochs) continue;
      const double slant = mean.slant / mean.n, delay = mean.delay_m / mean.n;
      n += 1.0;
      x += slant;
      y += delay;
      xx += slant * slant;
      xy += slant * delay;
      yy += delay * delay;
    }
    place += highest;
    if (n < kMinOfSystem) continue;
    line.satellites += static_cast<int>(n);
    ++line.systems;
    line.xx += xx - x * x / n;
    line.xy += xy - x * y / n;
    line.yy += yy - y * y / n;
  }
  const int free = line.satellites - line.systems - 1;
  if (line.satellites < kMinSatellites || free < 3 || !(line.xx > 0.0)) return {};
  const double slope = line.xy / line.xx;
  const double variance = std::max(0.0, line.yy - slope * line.xy) / free / line.xx;
  const bool exchanged = slope < -kMin_m && slope < -kClear * std::sqrt(variance);
  return exchanged ? ConventionFinding{Convention::kCodesExchanged, slope} : ConventionFinding();
}

}  // namespace leonav
