#include "tools/quality/internal/slip_text.h"

#include <cmath>
#include <map>
#include <numbers>

#include "tools/common/format.h"
#include "tools/quality/internal/number.h"

namespace leonav {
namespace {

std::string per_slip(const SlipTotals& totals) {
  const double value = totals.observations_per_slip();
  return std::isfinite(value) ? format("%9.0f", value) : format("%9s", "-");
}

std::string causes_table(const Quality& quality) {
  std::map<SlipCause, std::uint64_t> counts;
  for (const ArcBreak& one : quality.breaks) {
    for (const SlipCause cause : kSlipCauses) counts[cause] += one.causes.has(cause) ? 1 : 0;
  }
  std::string out;
  for (const auto& [cause, count] : counts) {
    if (count > 0)
      out += format("%s%s %llu", out.empty() ? "  found by: " : ", ",
                    std::string(to_string(cause)).c_str(), number(count));
  }
  return out.empty() ? "" : out + "\n";
}

}  // namespace

double SlipTotals::observations_per_slip() const {
  return slips == 0 ? std::numeric_limits<double>::quiet_NaN()
                    : static_cast<double>(followed) / static_cast<double>(slips);
}

std::array<SlipTotals, kSystemCount> slip_totals(const Quality& quality) {
  std::array<SlipTotals, kSystemCount> totals;
  for (const auto& [id, satellite] : quality.satellites) {
    SlipTotals& sum = totals[index_of(id.system)];
    sum.followed += satellite.followed;
    sum.slips += satellite.slips;
    sum.flagged_slips += satellite.flagged_slips;
    sum.interruptions += satellite.interruptions;
    sum.unresolved += satellite.unresolved;
  }
  return totals;
}

std::string signals_text(const ArcBreak& one) {
  std::string out;
  for (const SignalCode code : one.signals) out += (out.empty() ? "" : "+") + to_string(code);
  return out;
}

std::string causes_text(SlipCauses causes) {
  std::string out;
  for (const SlipCause cause : kSlipCauses) {
    if (!causes.has(cause)) continue;
    if (!out.empty()) out += "+";
    out += to_string(cause);
  }
  return out;
}

std::string slips_table(const Quality& quality, std::size_t shown) {
  std::string out =
      "\nCycle slips\n"
      "            carriers   slips    told   o/slps  interruptions  half cycle open\n";
  const auto totals = slip_totals(quality);
  for (const System system : kSystems) {
    const SlipTotals& t = totals[index_of(system)];
    if (t.followed == 0) continue;
    out += format("  %-9s%9llu%8llu%8llu%s%15llu%17llu\n", std::string(to_string(system)).c_str(),
                  number(t.followed), number(t.slips), number(t.flagged_slips), per_slip(t).c_str(),
                  number(t.interruptions), number(t.unresolved));
  }
  out +=
      "  carriers: satellite-epochs followed; o/slps: these per slip; told: slips that the "
      "receiver\n"
      "  itself reports; the others are found by tests, which fading carriers can set off too\n";
  out += causes_table(quality);
  std::size_t printed = 0, slips = 0;
  for (const ArcBreak& one : quality.breaks) {
    if (!is_slip(one.causes)) continue;
    ++slips;
    if (printed == shown) continue;
    ++printed;
    const double elevation_deg = one.elevation * 180.0 / std::numbers::pi;
    out += format("  %d %10.3f  %-4s %-9s %5s deg  %s\n", one.time.week(), one.time.tow_s(),
                  to_string(one.satellite).c_str(), signals_text(one).c_str(),
                  std::isfinite(elevation_deg) ? format("%.1f", elevation_deg).c_str() : "-",
                  causes_text(one.causes).c_str());
  }
  if (slips > printed)
    out += format("  ... and %zu more (all of them: --json, --plots)\n", slips - printed);
  return out;
}

}  // namespace leonav
