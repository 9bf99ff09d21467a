#include "core/gnss/cycle_slips/internal/range_change_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/robust/random_subset.h"

namespace leonav {
namespace {

// With half of the rows wrong and four unknowns, one subset in sixteen is free of slips: all of 200
// contain one with a probability of 2e-6. Where fewer rows are wrong fewer subsets suffice, but
// enough are drawn that other explanations are found too.
constexpr std::size_t kSubsets = 200, kFewestSubsets = 48;
constexpr double kMissProbability = 2e-6;
constexpr int kRefits = 4;
constexpr double kWidening = 1.25;  // factor on the sigmas, per step
// Sets of slips whose costs differ by less than this (chi square, 1 degree of freedom, 3 sigma)
// explain the rows equally well.
constexpr double kMinCostDifference = 9.0;

struct Candidate {
  ChangeSet kept;
  double cost = 0.0;
};
using Starts = boost::container::static_vector<ChangeSet, kSubsets>;
using Candidates = boost::container::static_vector<Candidate, kSubsets>;

const Candidate& best_of(const Candidates& candidates) {
  return *std::min_element(candidates.begin(), candidates.end(),
                           [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
}

// Sets visited so far, and the start whose path went through each. The table is only looked up,
// never iterated over: the order of hashes decides nothing.
class VisitedSets {
 public:
  VisitedSets() { slots_.fill(kEmpty); }
  // Returns the start whose path went through `set`; if none did, notes the set and returns
  // `start`.
  struct Meeting {
    std::size_t start;
    bool met;
  };
  Meeting meet(const ChangeSet& set, std::size_t start) {
    std::size_t slot = std::hash<ChangeSet>()(set) % kSlots;
    for (; slots_[slot] != kEmpty; slot = (slot + 1) % kSlots) {
      const Visit& visit = visits_[slots_[slot]];
      if (visit.set == set) return {visit.start, true};
    }
    slots_[slot] = static_cast<std::uint16_t>(visits_.size());
    visits_.push_back({set, start});
    return {start, false};
  }

 private:
  static constexpr std::size_t kSlots = 2048;  // more than twice the visits
  static constexpr std::uint16_t kEmpty = 0xffff;
  static_assert(2 * kSubsets * kRefits < kSlots);
  struct Visit {
    ChangeSet set;
    std::size_t start = 0;
  };
  std::array<std::uint16_t, kSlots> slots_;
  boost::container::static_vector<Visit, kSubsets * kRefits> visits_;
};

class Search {
 public:
  Search(const ChangeFitter& fitter, std::size_t subset, const CycleSlipConfig& config)
      : fitter_(fitter), config_(config), subset_(subset) {}
  SlipSearch run();

 private:
  Candidate converge(ChangeSet kept, double scale, VisitedSets* visits) const;
  bool has_clean_subset() const;
  void draw();

  const ChangeFitter& fitter_;
  const CycleSlipConfig& config_;
  std::size_t subset_;
  Starts starts_;
  Candidates candidates_;
};

// Alternates between fitting the kept rows and keeping the rows that agree with the fit. Most
// starts soon meet the path of an earlier one, and end where that ended.
Candidate Search::converge(ChangeSet kept, double scale, VisitedSets* visits) const {
  const std::size_t start = candidates_.size();
  ChangeSet fitted;
  ChangeFit fit;
  for (int refit = 0; refit < kRefits; ++refit) {
    const VisitedSets::Meeting meeting = visits->meet(kept, start);
    if (meeting.start != start) return candidates_[meeting.start];
    if (meeting.met) break;
    fitted = kept;
    fit = fitter_.fit(fitted, scale);
    kept = fitter_.agreeing(fitted, fit);
  }
  if (kept != fitted) fit = fitter_.fit(kept, scale);
  return {kept, fitter_.cost(kept, fit)};
}

// Returns whether the subsets drawn include a clean one almost surely, if the best rows are clean.
bool Search::has_clean_subset() const {
  const std::size_t drawn = starts_.size();
  if (drawn < kFewestSubsets) return false;
  const double share =
      static_cast<double>(best_of(candidates_).kept.count()) / static_cast<double>(fitter_.size());
  const double clean = std::pow(share, static_cast<double>(subset_));
  return std::pow(1.0 - clean, static_cast<double>(drawn)) < kMissProbability;
}

// Draws the starts: each is the half of the rows nearest to a fit through few randomly drawn rows.
void Search::draw() {
  RandomSubset subsets;
  VisitedSets visits;
  while (starts_.size() < kSubsets) {
    ChangeSet subset;
    subsets.choose(fitter_.size(), subset_, &subset);
    starts_.push_back(fitter_.nearest_half(fitter_.fit(subset, 1.0), subset_));
    candidates_.push_back(converge(starts_.back(), 1.0, &visits));
    if (has_clean_subset()) return;
  }
}

// The sigmas are raised only where the rows that agree best scatter by more than their sigmas: a
// median over all rows would include slips.
SlipSearch Search::run() {
  SlipSearch result;
  double& scale = result.scale;
  draw();
  while (scale < config_.max_scale &&
         fitter_.scatter(best_of(candidates_).kept, scale) > kWidening * scale) {
    scale = std::min(kWidening * scale, config_.max_scale);
    VisitedSets visits;
    candidates_.clear();
    for (const ChangeSet& start : starts_) candidates_.push_back(converge(start, scale, &visits));
  }
  const Candidate& best = best_of(candidates_);
  result.kept = best.kept;
  const double allowance = static_cast<double>(best.kept.count()) - fitter_.parameters(best.kept);
  const double slipped = static_cast<double>(fitter_.size() - best.kept.count());
  result.decided = allowance > 0.75 && allowance > slipped - 0.25;
  for (const Candidate& candidate : candidates_) {
    if (candidate.cost < best.cost + kMinCostDifference)
      result.doubtful |= candidate.kept ^ best.kept;
  }
  return result;
}

}  // namespace

SlipSearch search_slips(const ChangeFitter& fitter, std::size_t subset,
                        const CycleSlipConfig& config) {
  return Search(fitter, subset, config).run();
}

}  // namespace leonav
