#include "core/installation_checks/internal/range_rate_monitor.h"

#include "core/installation_checks/internal/is_near.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace leonav {
namespace {

constexpr double kLongestInterval_s = 3.0;  // over longer times a rate is not steady
constexpr double kMinDopplerSquares = 1e5;  // (m/s)^2, Dopplers about their mean
constexpr int kMinRateEpochs = 8;
constexpr int kMinRateSatellites = 3;
constexpr double kMinCorrelation = 0.9;  // squared correlation
constexpr double kRateWithin = 0.1, kBandWithin = 0.03;
constexpr double kSignificance = 5.0;  // sigmas

std::size_t band_of(SignalCode code) {
  return code.band >= '0' && code.band <= '9' ? static_cast<std::size_t>(code.band - '0') : 0;
}

// Returns whether the factor is the one that results from the other band's name; false if the two
// differ too little.
bool matches_other_band(double factor, double ratio) {
  return is_near(factor, ratio, kBandWithin) && !is_near(ratio, 1.0, 2.0 * kBandWithin);
}

}  // namespace

// Returns the ratio of two bands' frequencies, which is the inverse ratio of their wavelengths; NaN
// if the system does not have both.
double RangeRateMonitor::ratio_of(System system, std::size_t a, std::size_t b) const {
  return bands_.frequency_hz(system, static_cast<char>('0' + a)) /
         bands_.frequency_hz(system, static_cast<char>('0' + b));
}

void RangeRateMonitor::Sums::add(const Sums& epoch) {
  if (epoch.n < kMinRateSatellites) return;
  xx += epoch.xx - epoch.x * epoch.x / epoch.n;
  xy += epoch.xy - epoch.x * epoch.y / epoch.n;
  yy += epoch.yy - epoch.y * epoch.y / epoch.n;
  ++epochs;
}

bool RangeRateMonitor::Sums::known() const {
  return epochs >= kMinRateEpochs && xx > kMinDopplerSquares && xy * xy > kMinCorrelation * xx * yy;
}

// The sigma comes from the scatter of the codes about the line, with at least three satellites and
// their mean removed.
bool RangeRateMonitor::Sums::differs_from_one() const {
  if (!known()) return false;
  const double scatter = std::max(0.0, yy - xy * factor()) / ((kMinRateSatellites - 1) * epochs);
  return std::abs(factor() - 1.0) > kSignificance * std::sqrt(scatter / xx);
}

void RangeRateMonitor::add(const RawEpoch& epoch) {
  const double dt = last_time_.is_set() ? seconds_between(epoch.time, last_time_) : 0.0;
  if (dt > 0.0 && dt <= kLongestInterval_s) compare(epoch, dt);
  last_time_ = epoch.time;
  last_.clear();
  for (const SignalObservation& now : epoch.observations)
    last_.push_back({now.satellite, now.code, now.pseudorange_m, now.doppler_hz});
}

// Both epochs are sorted in the same order. Dopplers are instantaneous, so that their mean is taken
// over both ends.
void RangeRateMonitor::compare(const RawEpoch& epoch, double dt) {
  Table table{};
  auto before = last_.begin();
  for (const SignalObservation& now : epoch.observations) {
    const auto key = std::tie(now.satellite, now.code);
    while (before != last_.end() && std::tie(before->satellite, before->code) < key) ++before;
    if (before == last_.end() || std::tie(before->satellite, before->code) != key) continue;
    const double wavelength = bands_.wavelength_m(now.satellite.system, now.code.band);
    const double x = -0.5 * wavelength * (now.doppler_hz + before->doppler_hz);
    const double y = (now.pseudorange_m - before->pseudorange_m) / dt;
    if (!std::isfinite(x + y)) continue;
    Sums& sums = table[index_of(now.satellite.system)][band_of(now.code)];
    sums.n += 1.0;
    sums.x += x;
    sums.y += y;
    sums.xx += x * x;
    sums.xy += x * y;
    sums.yy += y * y;
  }
  for (std::size_t system = 0; system < kSystemCount; ++system)
    for (std::size_t band = 0; band < kBands; ++band) sums_[system][band].add(table[system][band]);
}

RangeRateMonitor::Sums RangeRateMonitor::all() const {
  Sums all;
  for (const auto& system : sums_) {
    for (const Sums& sums : system) {
      all.xx += sums.xx;
      all.xy += sums.xy;
      all.yy += sums.yy;
      all.epochs = std::max(all.epochs, sums.epochs);
    }
  }
  return all;
}

bool RangeRateMonitor::is_right() const {
  const Sums sums = all();
  return sums.known() && is_near(sums.factor(), 1.0, kRateWithin);
}

// Returns the factor of the first of two bands of the system that certainly have each other's
// names; 0 if there are none.
double RangeRateMonitor::exchanged_factor(System system) const {
  const auto& bands = sums_[index_of(system)];
  for (std::size_t i = 1; i < kBands; ++i) {
    for (std::size_t j = i + 1; j < kBands; ++j) {
      if (!bands[i].differs_from_one() || !bands[j].differs_from_one()) continue;
      const double ratio = ratio_of(system, i, j);
      if (matches_other_band(bands[i].factor(), ratio) &&
          matches_other_band(bands[j].factor(), 1.0 / ratio))
        return bands[i].factor();
    }
  }
  return 0.0;
}

// The other band may have too few satellites: a phone measures L1 of all and L5 of few.
bool RangeRateMonitor::is_mislabelled(System system, std::size_t band) const {
  const double factor = sums_[index_of(system)][band].factor();
  for (std::size_t other = 1; other < kBands; ++other)
    if (other != band && matches_other_band(factor, ratio_of(system, band, other))) return true;
  return false;
}

ConventionFinding RangeRateMonitor::evaluate() const {
  double first = 0.0;  // factor of the first band known
  // Counts of bands: known ones, right ones, those with another band's factor, those whose factor
  // is not 1.
  int known = 0, right = 0, others = 0, not_one = 0;
  for (const System system : kSystems) {
    const auto& bands = sums_[index_of(system)];
    for (std::size_t band = 1; band < kBands; ++band) {
      if (!bands[band].known()) continue;
      if (known++ == 0) first = bands[band].factor();
      right += is_near(bands[band].factor(), 1.0, kRateWithin);
      others += is_mislabelled(system, band);
      not_one += bands[band].differs_from_one();
    }
    const double exchanged = exchanged_factor(system);
    if (exchanged != 0.0) return {Convention::kSignalsExchanged, exchanged};
  }
  // The factor of a right band is also that of another band if the two are close together.
  if (known == 0 || right > 0) return {};
  if (others == known && not_one == known) return {Convention::kSignalsExchanged, first};
  // Bands that contradict each other indicate neither a wrong sign nor a wrong unit.
  const Sums sums = all();
  if (others > 0 || !sums.differs_from_one()) return {};
  if (is_near(sums.factor(), -1.0, kRateWithin)) return {Convention::kDopplerSign, sums.factor()};
  return {Convention::kDopplerUnit, sums.factor()};
}

}  // namespace leonav
