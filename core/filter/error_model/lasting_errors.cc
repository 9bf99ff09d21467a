#include "core/filter/error_model/lasting_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr double kMovingBlock_s = 30.0, kStandingBlock_s = 300.0, kLeoBlock_s = 10.0;
constexpr double kLongestStep_s = 10.0;
constexpr double kForgotten_s = 900.0;  // a satellite not seen for longer begins anew
constexpr std::size_t kMinBlocks = 4;
constexpr double kScatters = 3.0;  // b
constexpr double kStated = 5.0;    // c
constexpr double kLeast_m = 1.0;
constexpr int kMinSatellites = 3;
constexpr double kUnknowns = 4.0;  // position and clock
// Of the satellites whose errors last: to find wrong orbits, and to take them for wrong still.
constexpr double kShareToFind = 1.0 / 3.0, kShareToKeep = 1.0 / 6.0;

}  // namespace

LastingErrors::Track* LastingErrors::find(const Sample& sample, GpsTime time) {
  Track anew;
  anew.satellite = sample.satellite;
  anew.orbit = sample.orbit;
  anew.last_time = time;
  const auto found = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) {
    return track.satellite == sample.satellite;
  });
  if (found != tracks_.end()) {
    const bool old =
        found->orbit != sample.orbit || seconds_between(time, found->last_time) > kForgotten_s;
    if (old) *found = anew;
    return &*found;
  }
  if (tracks_.size() == tracks_.capacity()) {
    const auto oldest =
        std::min_element(tracks_.begin(), tracks_.end(),
                         [](const Track& a, const Track& b) { return a.last_time < b.last_time; });
    *oldest = anew;
    return &*oldest;
  }
  tracks_.push_back(anew);
  return &tracks_.back();
}

void LastingErrors::add(const Sample& sample, GpsTime time) {
  Track& track = *find(sample, time);
  const double step_s = std::clamp(seconds_between(time, track.last_time), 0.0, kLongestStep_s);
  track.last_time = time;
  const bool leo = sample.satellite.system == System::kLeo;
  const double block_s = leo ? kLeoBlock_s : sample.standing ? kStandingBlock_s : kMovingBlock_s;
  track.progress += step_s / block_s;
  track.residuals += sample.residual_m;
  track.redundancies += sample.redundancy;
  track.variances += sample.stated_variance - square(sigma_m(sample.satellite.system));
  ++track.count;
  if (track.progress < 1.0) return;
  if (track.means.size() == kBlocks) track.means.erase(track.means.begin());
  track.means.push_back(track.residuals / track.count);
  track.redundancy = track.redundancies / track.count;
  track.stated_variance = std::max(track.variances / track.count, 0.0);
  track.progress = track.residuals = track.redundancies = track.variances = 0.0;
  track.count = 0;
}

LastingErrors::Evidence LastingErrors::evaluate(System system) const {
  Evidence evidence;
  for (const Track& track : tracks_) {
    if (track.satellite.system != system || track.means.size() < kMinBlocks) continue;
    const auto n = static_cast<double>(track.means.size());
    double mean = 0.0, scatter = 0.0;
    for (const double block : track.means) mean += block / n;
    for (std::size_t i = 1; i < track.means.size(); ++i)
      scatter += square(track.means[i] - track.means[i - 1]) / (2.0 * (n - 1.0));
    const bool lasts = square(mean) > square(kScatters) * scatter &&
                       square(mean) > square(kStated) * track.stated_variance &&
                       std::abs(mean) > kLeast_m;
    ++evidence.satellites;
    evidence.lasting += lasts ? 1 : 0;
    evidence.squares += square(mean);
    evidence.redundancies += track.redundancy;
  }
  return evidence;
}

void LastingErrors::end_epoch(GpsTime time) {
  const auto forgotten = [&](const Track& track) {
    return seconds_between(time, track.last_time) > kForgotten_s;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), forgotten), tracks_.end());
  const std::array<double, kSystemCount> before_m = sigma_m_;
  std::array<bool, kSystemCount> tested{};
  int satellites = 0, systems = 0, wrong_systems = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    const Evidence evidence = evaluate(kSystems[i]);
    tested[i] = evidence.satellites >= kMinSatellites && evidence.redundancies > 0.0;
    if (!tested[i]) continue;
    ++systems;
    satellites += evidence.satellites;
    const double share = static_cast<double>(evidence.lasting) / evidence.satellites;
    const bool found = share >= kShareToFind && evidence.lasting >= kMinSatellites;
    const bool wrong = before_m[i] > 0.0 ? share > kShareToKeep : found;
    sigma_m_[i] = wrong ? std::sqrt(evidence.squares / evidence.redundancies) : 0.0;
    if (!wrong) continue;
    ++wrong_systems;
    least_m = std::min(least_m, sigma_m_[i]);
  }
  if (2 * wrong_systems > systems)
    for (std::size_t i = 0; i < kSystemCount; ++i) sigma_m_[i] = std::max(sigma_m_[i], least_m);
  alike_ = wrong_systems == 0 ? 1.0 : std::sqrt(std::max(satellites / kUnknowns, 1.0));
}

}  // namespace leonav
