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

using Values = boost::container::static_vector<double, kMaxArcs>;

// What the carriers of a system have in common, m.
struct Clock {
  double innovation_m = 0.0, followed_m = 0.0;
};

double followed(const CarrierInnovation& carrier) {
  return carrier.innovation_m - carrier.residual_m;
}

// The medians of each system's carriers, or of all for a system that has few.
std::array<Clock, kSystemCount> clocks_of(const CarrierInnovations& carriers) {
  struct Lists {
    Values innovations, followed;
    Clock medians() const { return {median(innovations), median(followed)}; }
  };
  std::array<Lists, kSystemCount> of_system;
  Lists all;
  for (const CarrierInnovation& carrier : carriers) {
    for (Lists* lists : {&of_system[index_of(carrier.satellite.system)], &all}) {
      lists->innovations.push_back(carrier.innovation_m);
      lists->followed.push_back(followed(carrier));
    }
  }
  std::array<Clock, kSystemCount> clocks{};
  if (carriers.empty()) return clocks;
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    const bool enough = of_system[i].innovations.size() >= kMinOfSystem;
    clocks[i] = (enough ? of_system[i] : all).medians();
  }
  return clocks;
}

}  // namespace

CarrierInnovations carrier_innovations(const FilterEvidence& evidence) {
  CarrierInnovations carriers;
  for (const FilterMeasurement& m : evidence.filter.measurements()) {
    if (m.observable != Observable::kCarrier || m.ambiguity < 0) continue;
    // An arc that begins has an ambiguity which makes its innovation zero.
    if (evidence.filter.estimate().ambiguity_of_state(m.ambiguity).started == evidence.time)
      continue;
    if (carriers.size() == carriers.capacity()) break;
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
    const Clock& clock = clocks[index_of(carrier.satellite.system)];
    track->last = time;
    track->pending += (carrier.innovation_m - clock.innovation_m) / carrier.sigma_m;
    track->followed_m += followed(carrier) - clock.followed_m;
  }
}

std::size_t SatelliteFaultMonitor::take_samples(GpsTime time) {
  Values sizes, followed;
  for (const Track& track : tracks_) {
    if (track.last != time) continue;
    sizes.push_back(std::abs(track.pending));
    followed.push_back(std::abs(track.followed_m));
  }
  const bool enough = sizes.size() >= kMinTracks;
  if (enough) {
    const double usual = median(sizes) / kNormalMedian;
    scale_ = scale_ > 0.0 ? scale_ + kScaleGain * (usual - scale_) : usual;
    usual_followed_m_ = median(followed) / kNormalMedian;
  }
  const double keep = std::exp(-1.0 / kMemory);
  for (Track& track : tracks_) {
    if (track.last != time) continue;
    if (enough && scale_ > 0.0) {
      track.sum = keep * track.sum + std::clamp(track.pending / scale_, -kLimit, kLimit);
      track.squares = keep * keep * track.squares + 1.0;
      track.followed_m *= keep;
    }
    track.pending = 0.0;
  }
  return sizes.size();
}

std::optional<SatelliteFault> SatelliteFaultMonitor::add(const CarrierInnovations& carriers,
                                                         GpsTime time) {
  if (!begun_.is_set()) begun_ = time;
  exclusions_.erase(std::remove_if(exclusions_.begin(), exclusions_.end(),
                                   [&](const Exclusion& e) { return e.end < time; }),
                    exclusions_.end());
  if (last_sample_.is_set() && seconds_between(time, last_sample_) > kLongestGap_s) begun_ = time;
  if (seconds_between(time, begun_) < kSettling_s) {
    last_sample_ = time;
    return std::nullopt;
  }
  collect(carriers, time);
  if (last_sample_.is_set() && seconds_between(time, last_sample_) < kSpacing_s)
    return std::nullopt;
  last_sample_ = time;
  const std::size_t count = take_samples(time);
  if (count < kMinTracks || (exclusions_.size() + 1) * kTracksPerExclusion > count)
    return std::nullopt;
  // Only a satellite that is seen can be told apart from what the filter has followed of it.
  const auto statistic = [time](const Track& track) {
    return track.last == time ? track.statistic() : 0.0;
  };
  const auto worst =
      std::max_element(tracks_.begin(), tracks_.end(),
                       [&](const Track& a, const Track& b) { return statistic(a) < statistic(b); });
  if (statistic(*worst) < kThreshold) return std::nullopt;
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

std::optional<FollowedRange> SatelliteFaultMonitor::followed_range(SatelliteId satellite,
                                                                   SignalCode code) const {
  if (!(usual_followed_m_ > 0.0)) return std::nullopt;
  for (const Track& track : tracks_)
    if (track.satellite == satellite && track.code == code)
      return FollowedRange{track.followed_m, usual_followed_m_};
  return std::nullopt;
}

void SatelliteFaultMonitor::filter_restarted(bool time_begins_anew) {
  tracks_.clear();
  begun_ = last_sample_ = GpsTime();
  scale_ = usual_followed_m_ = 0.0;
  if (time_begins_anew) exclusions_.clear();
}

}  // namespace leonav
