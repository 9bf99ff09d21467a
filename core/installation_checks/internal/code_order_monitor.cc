#include "core/installation_checks/internal/code_order_monitor.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/propagation/group_delay.h"

namespace leonav {
namespace {

constexpr double kShellShare = 0.94;    // radius of the Earth over that of a shell at 400 km
constexpr double kMinElevation = 0.17;  // rad
constexpr float kMinCodeEpochs = 20.0F;
constexpr int kMinCodeSatellites = 8, kMinOfSystem = 3, kMinFree = 3;
constexpr double kClearSlope = 5.0;  // sigmas
constexpr double kMuchLess = 0.5;
constexpr double kMin_m = 0.5;  // at zenith, on L1: near the least delay of a quiet night

// Returns the slant factor of the path through a thin shell: 1 at the zenith, about 2.5 near the
// horizon.
double slant_of(double elevation) {
  const double sine = kShellShare * std::cos(elevation);
  return 1.0 / std::sqrt(1.0 - sine * sine);
}

double group_delay_m(SignalCode code, const Ephemeris* elements) {
  return elements == nullptr ? 0.0 : group_delay(*elements, code).delay_m;
}

// The difference of two codes of one satellite.
struct Pair {
  double difference_m = 0.0;        // second minus first
  double group_difference_m = 0.0;  // second minus first, of the satellite's group delays
  double share = 0.0;               // of the ionosphere's delay on L1 in the difference

  double delay_m(bool exchanged) const {
    return ((exchanged ? -difference_m : difference_m) - group_difference_m) / share;
  }
  bool usable() const {
    // The difference of two close bands is mostly noise.
    return std::abs(share) > 0.2 && std::isfinite(difference_m) && std::abs(difference_m) < 200.0;
  }
};

Pair pair_of(const BandPlan& bands, const SignalObservation& first, const SignalObservation& second,
             const Ephemeris* elements) {
  Pair pair;
  const System system = first.satellite.system;
  const double f1 = bands.frequency_hz(system, first.code.band);
  const double f2 = bands.frequency_hz(system, second.code.band);
  const double fl1 = frequency_hz(System::kGps, '1');
  if (!(f1 > 0.0) || !(f2 > 0.0)) return pair;
  pair.share = fl1 * fl1 * (1.0 / (f2 * f2) - 1.0 / (f1 * f1));
  pair.difference_m = second.pseudorange_m - first.pseudorange_m;
  pair.group_difference_m =
      group_delay_m(second.code, elements) - group_delay_m(first.code, elements);
  return pair;
}

// The first signal of a satellite and the first one on another band; nullptr where there is none.
struct Signals {
  const SignalObservation *first = nullptr, *second = nullptr;
};
Signals signals_of(SatelliteId satellite, const RawEpoch& epoch) {
  Signals signals;
  for (const SignalObservation& observation : epoch.observations) {
    if (observation.satellite != satellite) continue;
    if (!std::isfinite(observation.pseudorange_m)) continue;
    if (signals.first == nullptr) signals.first = &observation;
    if (observation.code.band == signals.first->code.band) continue;
    signals.second = &observation;
    break;
  }
  return signals;
}

}  // namespace

void CodeOrderMonitor::add(const RawEpoch& epoch, const MeasurementEpoch& seen,
                           const EphemerisStore& ephemeris_store) {
  for (const SatelliteInView& seen_one : seen.satellites) {
    const SatelliteId satellite = seen_one.satellite;
    if (!is_valid(satellite) || !(seen_one.elevation > kMinElevation)) continue;
    const Signals signals = signals_of(satellite, epoch);
    if (signals.second == nullptr) continue;
    const bool has_group_delay = satellite.system != System::kLeo;
    const Ephemeris* elements =
        has_group_delay ? ephemeris_store.ephemeris_at(satellite, epoch.time) : nullptr;
    const Pair pair = pair_of(bands_, *signals.first, *signals.second, elements);
    if (!pair.usable()) continue;
    Mean& mean = satellites_[table_index_of(satellite)];
    mean.n += 1.0F;
    mean.slant += static_cast<float>(slant_of(seen_one.elevation));
    mean.delay_m[0] += static_cast<float>(pair.delay_m(false));
    mean.delay_m[1] += static_cast<float>(pair.delay_m(true));
  }
}

CodeOrderMonitor::Line CodeOrderMonitor::line(std::size_t exchanged) const {
  int satellites = 0, systems = 0;
  double sxx = 0.0, sxy = 0.0, syy = 0.0;
  std::size_t first_index = 0;
  for (const std::uint16_t highest : kHighestNumber) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = first_index; i < first_index + highest; ++i) {
      const Mean& mean = satellites_[i];
      if (mean.n < kMinCodeEpochs) continue;
      const double slant = mean.slant / mean.n, delay = mean.delay_m[exchanged] / mean.n;
      n += 1.0;
      x += slant;
      y += delay;
      xx += slant * slant;
      xy += slant * delay;
      yy += delay * delay;
    }
    first_index += highest;
    if (n < kMinOfSystem) continue;
    satellites += static_cast<int>(n);
    ++systems;
    sxx += xx - x * x / n;
    sxy += xy - x * y / n;
    syy += yy - y * y / n;
  }
  const int free = satellites - systems - 1;
  Line line;
  line.known = satellites >= kMinCodeSatellites && free >= kMinFree && sxx > 0.0;
  if (!line.known) return line;
  line.slope = sxy / sxx;
  line.sigma = std::sqrt(std::max(0.0, syy - line.slope * sxy) / free / sxx);
  return line;
}

ConventionFinding CodeOrderMonitor::evaluate() const {
  const Line as_labelled = line(0), exchanged = line(1);
  if (!as_labelled.known || !exchanged.known) return {};
  // The group delays fit one order only; in the other they count twice and scatter.
  const bool fits_better =
      exchanged.sigma < kMuchLess * as_labelled.sigma || as_labelled.slope < 0.0;
  const bool clear =
      exchanged.slope > kMin_m && exchanged.slope > kClearSlope * exchanged.sigma && fits_better;
  if (!clear) return {};
  return {Convention::kCodesExchanged, exchanged.slope};
}

}  // namespace leonav
