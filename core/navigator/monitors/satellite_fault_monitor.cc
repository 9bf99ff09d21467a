#include "core/navigator/monitors/satellite_fault_monitor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/median.h"

namespace leonav {
namespace {

constexpr double kSettling_s = 60.0;  // after a start innovations show its convergence
constexpr double kSpacing_s = 0.9;    // samples are this far apart
constexpr double kMemory = 200.0;     // samples
constexpr double kLeastSquares = 25.0;
constexpr double kLongestGap_s = 60.0;
constexpr double kLimit = 3.0;  // of a sample
constexpr double kThreshold = 20.0;
constexpr double kScaleGain = 0.05;
constexpr double kNormalMedian = 0.6745;  // of |u|
// Fewer carriers do not outvote one; more than one satellite in four is no fault of satellites.
constexpr std::size_t kMinTracks = 6, kTracksPerExclusion = 4;
constexpr std::size_t kMinOfSystem = 4;
constexpr double kExclusion_s = 1800.0;

using Values = boost::container::static_vector<double, kMaxMeasurements>;

// The median innovation of each system's carriers, or of all for a system that has few.
std::array<double, kSystemCount> clocks_of(const CarrierInnovations& carriers) {
  std::array<Values, kSystemCount> of_system;
  Values all;
  for (const CarrierInnovation& carrier : carriers) {
    of_system[index_of(carrier.satellite.system)].push_back(carrier.innovation_m);
    all.push_back(carrier.innovation_m);
  }
  std::array<double, kSystemCount> clocks{};
  if (all.empty()) return clocks;
  const double of_all = median(all);
  for (std::size_t i = 0; i < kSystemCount; ++i)
    clocks[i] = of_system[i].size() >= kMinOfSystem ? median(of_system[i]) : of_all;
  return clocks;
}

}  // namespace

CarrierInnovations carrier_innovations(const FilterEvidence& evidence) {
  CarrierInnovations carriers;
  for (const FilterMeasurement& m : evidence.filter.measurements()) {
    if (m.observable != Observable::kCarrier) continue;
    const Measurement& measurement = evidence.measurements.measurements[m.index];
    carriers.push_back({evidence.measurements.satellites[measurement.satellite_index].satellite,
                        measurement.code, m.innovation,
                        evidence.update.innovations[m.index].residual, std::sqrt(m.variance)});
  }
  return carriers;
}

double SatelliteFaultMonitor::Track::statistic() const {
  return squares < kLeastSquares ? 0.0 : std::abs(sum) / std::sqrt(squares);
}

SatelliteFaultMonitor::Track* SatelliteFaultMonitor::track_of(SatelliteId satellite,
                                                              SignalCode code, GpsTime time) {
  for (Track& track : tracks_)
    if (track.satellite == satellite && track.code == code) return &track;
  if (tracks_.size() == tracks_.capacity()) return nullptr;
  Track track;
  track.satellite = satellite;
  track.code = code;
  track.last = time;
  tracks_.push_back(track);
  return &tracks_.back();
}

void SatelliteFaultMonitor::collect(const CarrierInnovations& carriers, GpsTime time) {
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [&](const Track& track) {
                                 return seconds_between(time, track.last) > kLongestGap_s;
                               }),
                tracks_.end());
  const auto clocks = clocks_of(carriers);
  for (const CarrierInnovation& carrier : carriers) {
    if (!(carrier.sigma_m > 0.0)) continue;
    Track* track = track_of(carrier.satellite, carrier.code, time);
    if (track == nullptr) continue;
    track->last = time;
    track->pending +=
        (carrier.innovation_m - clocks[index_of(carrier.satellite.system)]) / carrier.sigma_m;
    track->followed_m += carrier.innovation_m - carrier.residual_m;
  }
}

std::size_t SatelliteFaultMonitor::take_samples(GpsTime time) {
  Values sizes;
  for (const Track& track : tracks_)
    if (track.last == time) sizes.push_back(std::abs(track.pending));
  const double keep = std::exp(-1.0 / kMemory);
  const std::size_t count = sizes.size();
  if (count > 0) {
    const double usual = median(sizes) / kNormalMedian;
    scale_ = scale_ > 0.0 ? scale_ + kScaleGain * (usual - scale_) : usual;
  }
  for (Track& track : tracks_) {
    track.followed_m *= keep;
    if (track.last != time || !(scale_ > 0.0)) continue;
    track.sum = keep * track.sum + std::clamp(track.pending / scale_, -kLimit, kLimit);
    track.squares = keep * keep * track.squares + 1.0;
    track.pending = 0.0;
  }
  return count;
}

std::optional<SatelliteFault> SatelliteFaultMonitor::add(const CarrierInnovations& carriers,
                                                         GpsTime time) {
  if (!begun_.is_set()) begun_ = time;
  exclusions_.erase(std::remove_if(exclusions_.begin(), exclusions_.end(),
                                   [&](const Exclusion& e) { return e.end < time; }),
                    exclusions_.end());
  if (seconds_between(time, begun_) < kSettling_s) return std::nullopt;
  collect(carriers, time);
  if (last_sample_.is_set() && seconds_between(time, last_sample_) < kSpacing_s)
    return std::nullopt;
  last_sample_ = time;
  const std::size_t count = take_samples(time);
  if (count < kMinTracks || (exclusions_.size() + 1) * kTracksPerExclusion > count)
    return std::nullopt;
  const auto worst = std::max_element(
      tracks_.begin(), tracks_.end(),
      [](const Track& a, const Track& b) { return a.statistic() < b.statistic(); });
  if (worst->statistic() < kThreshold) return std::nullopt;
  const SatelliteFault fault = {worst->satellite, std::abs(worst->followed_m)};
  exclusions_.push_back({fault.satellite, time.plus_seconds(kExclusion_s)});
  tracks_.clear();  // the others have been measured against it
  return fault;
}

ExcludedSatellites SatelliteFaultMonitor::excluded(GpsTime time) const {
  ExcludedSatellites satellites;
  for (const Exclusion& exclusion : exclusions_)
    if (time <= exclusion.end) satellites.push_back(exclusion.satellite);
  return satellites;
}

void SatelliteFaultMonitor::filter_restarted(bool time_begins_anew) {
  tracks_.clear();
  begun_ = last_sample_ = GpsTime();
  scale_ = 0.0;
  if (time_begins_anew) exclusions_.clear();
}

}  // namespace leonav
