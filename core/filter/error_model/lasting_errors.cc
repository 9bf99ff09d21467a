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
constexpr double kHold_s = 240.0;      // a system that is right for so long is right
constexpr std::size_t kMinBlocks = 4;
constexpr double kScatters = 3.0;  // b
constexpr double kStated = 3.0;    // c
constexpr double kLeast_m = 1.0;
constexpr int kMinSatellites = 4;    // to test a system
constexpr int kMinToFind = 3;        // with lasting errors, to find it wrong
constexpr int kMinToKeep = 2;        // to take it for wrong still
constexpr double kFoundAgain = 2.0;  // an error that has grown so is found again
// The position allows for an L that has grown or fallen so.
constexpr double kGrown = 1.5, kFallen = 0.5;
constexpr double kPointUnknowns = 4.0;  // position and clock
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
  if (!(step_s >= 0.0 && step_s <= kForgotten_s)) track = {sample.satellite, time, {}, {}};
  track.last_time = time;
  Block& block = track.block;
  if (step_s >= 0.0 && step_s <= kLongestGap_s)
    block.progress += step_s * blocks_per_second(sample.satellite.system, sample.speed_m_s);
  else
    block = Block();
  block.residual += sample.residual_m;
  block.redundancy += sample.redundancy;
  block.stated_variance += sample.stated_variance;
  ++block.count;
  if (block.progress < 1.0) return;
  if (track.blocks.size() == kBlocks) track.blocks.erase(track.blocks.begin());
  block.residual /= block.count;
  block.redundancy /= block.count;
  block.stated_variance /= block.count;
  track.blocks.push_back(block);
  block = Block();
}

LastingErrors::Evidence LastingErrors::evaluate(System system, GpsTime time) const {
  Evidence evidence;
  boost::container::static_vector<Mean, kMaxArcs> means;
  for (const Track& track : tracks_) {
    if (track.satellite.system != system ||
        std::abs(seconds_between(time, track.last_time)) > kInView_s)
      continue;
    ++evidence.in_view;
    if (track.blocks.size() >= kMinBlocks) means.push_back(mean_of(track));
  }
  evidence.satellites = static_cast<int>(means.size());
  if (means.empty()) return evidence;
  std::sort(means.begin(), means.end(),
            [](const Mean& a, const Mean& b) { return a.residual < b.residual; });
  const std::size_t half = means.size() / 2;
  const double median = 0.5 * (means[half].residual + means[means.size() - 1 - half].residual);
  for (const Mean& mean : means) {
    const double own_square = std::min(square(mean.residual), square(mean.residual - median));
    const bool lasts = own_square > square(kScatters) * mean.scatter &&
                       own_square > square(kStated) * mean.stated_variance &&
                       own_square > square(kLeast_m);
    evidence.lasting += lasts ? 1 : 0;
    evidence.squares += square(mean.residual);
    evidence.redundancies += mean.redundancy;
  }
  return evidence;
}

LastingErrors::Mean LastingErrors::mean_of(const Track& track) {
  Mean mean;
  const auto n = static_cast<double>(track.blocks.size());
  for (const Block& block : track.blocks) {
    mean.residual += block.residual / n;
    mean.redundancy += block.redundancy / n;
    mean.stated_variance += block.stated_variance / n;
  }
  for (std::size_t i = 1; i < track.blocks.size(); ++i)
    mean.scatter +=
        square(track.blocks[i].residual - track.blocks[i - 1].residual) / (2.0 * (n - 1.0));
  return mean;
}

void LastingErrors::decide(const Evidence& evidence, GpsTime time, Verdict* verdict) {
  const bool old =
      verdict->tested.is_set() && std::abs(seconds_between(time, verdict->tested)) > kUntested_s;
  if (old) verdict->range_sigma_m = 0.0;
  if (evidence.satellites < kMinSatellites || !(evidence.redundancies > 0.0)) return;
  const double share = static_cast<double>(evidence.lasting) / evidence.satellites;
  const bool wrong = verdict->range_sigma_m > 0.0
                         ? share > kShareToKeep && evidence.lasting >= kMinToKeep
                         : share >= kShareToFind && evidence.lasting >= kMinToFind;
  if (wrong) {
    verdict->range_sigma_m = std::sqrt(evidence.squares / evidence.redundancies);
    verdict->wrong_until = time;
  } else if (verdict->range_sigma_m > 0.0 &&
             std::abs(seconds_between(time, verdict->wrong_until)) > kHold_s) {
    verdict->range_sigma_m = 0.0;
  }
  verdict->tested = time;
}

void LastingErrors::end_epoch(GpsTime time) {
  const auto forgotten = [&](const Track& track) {
    return std::abs(seconds_between(time, track.last_time)) > kForgotten_s;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), forgotten), tracks_.end());
  std::array<int, kSystemCount> satellites{};
  int in_view = 0, wrong = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    const Evidence evidence = evaluate(kSystems[i], time);
    satellites[i] = evidence.satellites;
    decide(evidence, time, &systems_[i]);
    const double range_sigma_m = systems_[i].range_sigma_m;
    in_view += evidence.in_view >= kMinSatellites || range_sigma_m > 0.0 ? 1 : 0;
    wrong += range_sigma_m > 0.0 ? 1 : 0;
    if (range_sigma_m > 0.0) least_m = std::min(least_m, range_sigma_m);
  }
  const double of_others_m = 2 * wrong > in_view ? least_m : 0.0;
  int alike = 0;
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    sigma_m_[i] = std::max(systems_[i].range_sigma_m, of_others_m);
    if (sigma_m_[i] > 0.0) alike += satellites[i];
  }
  const double factor = std::sqrt(std::max(alike / kPointUnknowns, 1.0));
  for (double& sigma_m : sigma_m_) sigma_m *= factor;
  note_change();
}

void LastingErrors::note_change() {
  change_ = {};
  double growth = 0.0;  // of a variance
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    Verdict& verdict = systems_[i];
    const bool found = verdict.range_sigma_m > kFoundAgain * verdict.reported_m;
    if (found) change_.found_m = std::max(change_.found_m, verdict.range_sigma_m);
    if (found || verdict.range_sigma_m == 0.0) verdict.reported_m = verdict.range_sigma_m;
    const double before_m = verdict.allowed_sigma_m;
    const bool grown = sigma_m_[i] > kGrown * before_m;
    if (grown) growth = std::max(growth, square(sigma_m_[i]) - square(before_m));
    if (grown || sigma_m_[i] < kFallen * before_m) verdict.allowed_sigma_m = sigma_m_[i];
    change_.codes_differ |= grown || (before_m > 0.0 && sigma_m_[i] == 0.0);
  }
  change_.growth_m = std::sqrt(growth);
}

}  // namespace leonav
