#include "core/gnss/cycle_slips/range_change.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/cycle_slips/internal/range_change_fit.h"
#include "core/gnss/cycle_slips/internal/range_change_rows.h"
#include "core/gnss/cycle_slips/internal/range_change_search.h"

namespace leonav {
namespace {

RangeChangeVerdict verdict_of(const ExternalDeviation& seen, const CycleSlipConfig& config) {
  if (seen.sigma_m == 0.0) return RangeChangeVerdict::kNotTested;
  if (seen.standardized() > config.range_change_limit &&
      std::abs(seen.value_m) > config.range_change_min_m)
    return RangeChangeVerdict::kSlipped;
  if (seen.standardized() > config.range_change_clear) return RangeChangeVerdict::kUnclear;
  return config.range_change_limit * seen.sigma_m <= config.range_change_power_m
             ? RangeChangeVerdict::kConsistent
             : RangeChangeVerdict::kNotTested;
}

void evaluate_rows(const ChangeRows& rows, const ChangeFitter& fitter, const SlipSearch& found,
                   const CycleSlipConfig& config, RangeChangeResult* result) {
  const ChangeFit fit = fitter.fit(found.kept, found.scale);
  result->change_m = rows.change_root * fit.state.head<3>();
  result->clock_change_m = rows.centre_m + rows.clock_unit_m * fit.state(kChangeClock);
  result->scale = found.scale;
  result->redundancy = static_cast<int>(
      std::lround(static_cast<double>(found.kept.count()) - fitter.parameters(found.kept)));
  result->status = RangeChangeStatus::kConsistent;
  for (std::size_t i = 0; i < fitter.size(); ++i) {
    RangeChangeRowResult& row = result->rows[rows.rows[i].source];
    const ExternalDeviation seen = fitter.external(i, fit, found.kept.test(i));
    row.deviation_m = seen.value_m;
    row.sigma_m = seen.sigma_m;
    if (!found.decided || found.doubtful.test(i)) {
      row.verdict = RangeChangeVerdict::kUndecided;
      result->status = RangeChangeStatus::kUndecidable;
      continue;
    }
    row.verdict = verdict_of(seen, config);
    if (row.verdict == RangeChangeVerdict::kSlipped &&
        result->status == RangeChangeStatus::kConsistent)
      result->status = RangeChangeStatus::kSlips;
  }
}

}  // namespace

RangeChangeResult range_change(std::span<const RangeChangeRow> given, const RangeChangePrior& prior,
                               const CycleSlipConfig& config) {
  RangeChangeResult result;
  result.rows.resize(std::min(given.size(), kMaxSatellites));
  const ChangeRows rows = scaled_rows(given.first(result.rows.size()), prior, config);
  if (rows.rows.size() < 2) return result;
  const ChangeFitter fitter(rows, config);
  SlipSearch found;
  found.kept = fitter.all();
  const double unknowns = fitter.parameters(found.kept);
  if (static_cast<double>(rows.rows.size()) - unknowns < 0.5) return result;
  const ChangeFit plain = fitter.fit(found.kept, 1.0);
  double worst = 0.0;
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    worst = std::max(worst, fitter.external(i, plain, true).standardized());
  }
  if (worst > config.range_change_clear) {
    const auto subset = static_cast<std::size_t>(std::max(1L, std::lround(unknowns)));
    found = search_slips(fitter, std::min(subset, rows.rows.size() - 1), config);
  }
  evaluate_rows(rows, fitter, found, config, &result);
  return result;
}

}  // namespace leonav
