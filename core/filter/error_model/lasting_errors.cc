#include "core/filter/error_model/lasting_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/square.h"

namespace leonav {
namespace {

constexpr double kBlock_s = 30.0, kBlock_m = 150.0, kLongestBlock_s = 900.0, kLeoBlock_s = 10.0;
constexpr double kLongestGap_s = 60.0;  // a longer one discards the block under way
constexpr double kInView_s = 120.0;     // satellites that were seen so lately are tested
constexpr double kForgotten_s = 900.0;
constexpr double kUntested_s = 600.0;  // after that a verdict ends
constexpr std::size_t kMinBlocks = 4;
constexpr double kScatters = 3.0;  // b
constexpr double kStated = 3.0;    // c
constexpr double kLeast_m = 1.0;
constexpr int kMinSatellites = 3;  // to test a system, and with lasting errors to find it wrong
constexpr int kMinToKeep = 2;      // to take it for wrong still
constexpr double kGrown = 2.0;     // an error that has grown so is found again
constexpr double kUnknowns = 4.0;  // position and clock
constexpr double kShareToFind = 1.0 / 3.0, kShareToKeep = 1.0 / 6.0;

double blocks_per_second(System system, double speed_m_s) {
  if (system == System::kLeo) return 1.0 / kLeoBlock_s;
  return std::clamp(speed_m_s / kBlock_m, 1.0 / kLongestBlock_s, 1.0 / kBlock_s);
}

}  // namespace

LastingErrors::Track* LastingErrors::find(SatelliteId satellite, GpsTime time) {
  const auto found = std::find_if(tracks_.begin(), tracks_.end(),
                                  [&](const Track& track) { return track.satellite == satellite; });
  if (found != tracks_.end()) return &*found;
  Track track;
  track.satellite = satellite;
  track.last_time = time;
  if (tracks_.size() < tracks_.capacity()) {
    tracks_.push_back(track);
    return &tracks_.back();
  }
  const auto oldest =
      std::min_element(tracks_.begin(), tracks_.end(),
                       [](const Track& a, const Track& b) { return a.last_time < b.last_time; });
  *oldest = track;
  return &*oldest;
}

void LastingErrors::add(const Sample& sample, GpsTime time) {
  Track& track = *find(sample.satellite, time);
  const double step_s = seconds_between(time, track.last_time);
  if (!(step_s >= 0.0 && step_s <= kLongestGap_s)) track.block = Block();
  track.last_time = time;
  Block& block = track.block;
  block.progress += std::clamp(step_s, 0.0, kLongestGap_s) *
                    blocks_per_second(sample.satellite.system, sample.speed_m_s);
  block.residuals += sample.residual_m;
  block.redundancies += sample.redundancy;
  block.variances += sample.stated_variance;
  ++block.count;
  if (block.progress < 1.0) return;
  if (track.means.size() == kBlocks) track.means.erase(track.means.begin());
  track.means.push_back(block.residuals / block.count);
  track.redundancy = block.redundancies / block.count;
  track.stated_variance = block.variances / block.count;
  block = Block();
}

LastingErrors::Evidence LastingErrors::evaluate(System system, GpsTime time) const {
  Evidence evidence;
  for (const Track& track : tracks_) {
    if (track.satellite.system != system || track.means.size() < kMinBlocks ||
        std::abs(seconds_between(time, track.last_time)) > kInView_s)
      continue;
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

void LastingErrors::decide(const Evidence& evidence, GpsTime time, Verdict* verdict) {
  if (evidence.satellites < kMinSatellites || !(evidence.redundancies > 0.0)) {
    const bool old =
        verdict->tested.is_set() && std::abs(seconds_between(time, verdict->tested)) > kUntested_s;
    if (old) *verdict = Verdict();
    return;
  }
  const double share = static_cast<double>(evidence.lasting) / evidence.satellites;
  const bool wrong = verdict->range_m > 0.0
                         ? share > kShareToKeep && evidence.lasting >= kMinToKeep
                         : share >= kShareToFind && evidence.lasting >= kMinSatellites;
  verdict->range_m = wrong ? std::sqrt(evidence.squares / evidence.redundancies) : 0.0;
  verdict->tested = time;
}

void LastingErrors::end_epoch(GpsTime time) {
  const auto forgotten = [&](const Track& track) {
    return std::abs(seconds_between(time, track.last_time)) > kForgotten_s;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), forgotten), tracks_.end());
  std::array<int, kSystemCount> satellites{};
  int tested = 0, wrong = 0;
  found_m_ = 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    const Evidence evidence = evaluate(kSystems[i], time);
    satellites[i] = evidence.satellites;
    decide(evidence, time, &systems_[i]);
    const double range_m = systems_[i].range_m;
    double& known_m = systems_[i].known_m;
    const bool found = range_m > kGrown * known_m;
    if (found) found_m_ = std::max(found_m_, range_m);
    if (found || range_m == 0.0) known_m = range_m;
    tested += evidence.satellites >= kMinSatellites || range_m > 0.0 ? 1 : 0;
    wrong += range_m > 0.0 ? 1 : 0;
    if (range_m > 0.0) least_m = std::min(least_m, range_m);
  }
  const double of_others_m = 2 * wrong > tested ? least_m : 0.0;
  int alike = 0;
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    sigma_m_[i] = std::max(systems_[i].range_m, of_others_m);
    if (sigma_m_[i] > 0.0) alike += satellites[i];
  }
  const double factor = std::sqrt(std::max(alike / kUnknowns, 1.0));
  for (double& sigma_m : sigma_m_) sigma_m *= factor;
}

}  // namespace leonav
