#include "tools/quality/internal/multipath.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace leonav {

double multipath_combination_m(double code_m, double own_carrier_m, double other_carrier_m,
                               double own_hz, double other_hz) {
  const double a = (own_hz / other_hz) * (own_hz / other_hz);
  const double k = 2.0 / (a - 1.0);
  return code_m - (1.0 + k) * own_carrier_m + k * other_carrier_m;
}

std::size_t elevation_bin(double elevation) {
  if (!std::isfinite(elevation)) return kNoElevation;
  const double tens = std::floor(elevation * 18.0 / std::numbers::pi);
  return static_cast<std::size_t>(std::clamp(tens, 0.0, 8.0));
}

double MultipathSum::rms_m() const {
  return samples == 0 ? std::numeric_limits<double>::quiet_NaN()
                      : std::sqrt(squares / static_cast<double>(samples));
}

void MultipathSum::add(const MultipathSum& other) {
  samples += other.samples;
  squares += other.squares;
}

MultipathSum MultipathOfSignal::all() const {
  MultipathSum sum;
  for (const MultipathSum& bin : bins) sum.add(bin);
  return sum;
}

std::size_t MultipathLevels::add(const Signal& signal, std::uint64_t arc, double value_m,
                                 double elevation) {
  Arc& open = open_[signal];
  if (open.id != arc) {
    if (open.id != 0) close(signal, open);
    open = Arc();
    open.id = arc;
    open.number = means_m_.size();
    means_m_.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  Moments& bin = open.bins[elevation_bin(elevation)];
  ++bin.samples;
  const double step = value_m - bin.mean;
  bin.mean += step / static_cast<double>(bin.samples);
  bin.squares += step * (value_m - bin.mean);
  return open.number;
}

void MultipathLevels::finish() {
  for (const auto& [signal, arc] : open_) close(signal, arc);
  open_.clear();
}

void MultipathLevels::close(const Signal& signal, const Arc& arc) {
  MultipathOfSignal& sums = signals_[signal];
  std::uint64_t samples = 0;
  double mean = 0.0;
  for (const Moments& bin : arc.bins) {
    samples += bin.samples;
    if (samples > 0)
      mean += (bin.mean - mean) * static_cast<double>(bin.samples) / static_cast<double>(samples);
  }
  if (samples < kMinSamples) {
    ++sums.short_arcs;
    sums.short_arc_samples += samples;
    return;
  }
  ++sums.arcs;
  means_m_[arc.number] = mean;
  const double freedom = static_cast<double>(samples) / static_cast<double>(samples - 1);
  for (std::size_t i = 0; i < kElevationBins; ++i) {
    const Moments& bin = arc.bins[i];
    const double off = bin.mean - mean;
    sums.bins[i].samples += bin.samples;
    sums.bins[i].squares += freedom * (bin.squares + static_cast<double>(bin.samples) * off * off);
  }
}

}  // namespace leonav
