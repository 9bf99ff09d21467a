#include "tools/evaluate/internal/residuals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/gnss/signals/satellite.h"
#include "drivers/csv/csv_rows.h"
#include "drivers/text/parse.h"
#include "tools/common/format.h"

namespace leonav {
namespace {

struct Sums {
  void add(double value) {
    ++count;
    sum += value;
    squares += value * value;
  }
  ResidualBin bin() const {
    if (count == 0) return {};
    const auto n = static_cast<double>(count);
    return {count, std::sqrt(squares / n), sum / n};
  }
  long count = 0;
  double sum = 0.0, squares = 0.0;
};

struct Group {
  Sums high;
  std::array<Sums, kResidualElevations.size()> bins;
};

std::size_t bin_of(double elevation_deg) {
  const auto next =
      std::upper_bound(kResidualElevations.begin(), kResidualElevations.end(), elevation_deg);
  return next == kResidualElevations.begin()
             ? 0
             : static_cast<std::size_t>(next - kResidualElevations.begin()) - 1;
}

}  // namespace

std::vector<ResidualRow> read_residuals(const std::string& path) {
  constexpr std::string_view kColumns = "satellite,observable,reason,residual,elevation_deg";
  CsvRows rows(path, kColumns,
               "measurements.csv of leonav-replay: ...,satellite,observable,...,"
               "reason,residual,elevation_deg");
  const int satellite = rows.column("satellite"), observable = rows.column("observable"),
            reason = rows.column("reason"), residual = rows.column("residual"),
            elevation = rows.column("elevation_deg");
  std::map<std::pair<System, std::string>, Group> groups;  // printed in order
  while (rows.next()) {
    const auto id = satellite_from_string(rows.text(satellite));
    const auto value = rows.number(residual), elevation_deg = rows.number(elevation);
    if (!id || !value || !elevation_deg) rows.mark_bad("no satellite, residual or elevation");
    if (rows.bad()) {
      rows.skip();
      continue;
    }
    if (rows.text(reason) != "used" && rows.text(reason) != "downweighted") continue;
    Group& group = groups[{id->system, std::string(rows.text(observable))}];
    group.bins[bin_of(*elevation_deg)].add(*value);
    if (*elevation_deg >= kResidualElevation_deg) group.high.add(*value);
  }
  rows.finish();
  if (groups.empty())
    throw FileError(path, 0, "no measurement in it counted; is it of a run without solution?");

  std::vector<ResidualRow> result;
  for (const auto& [key, group] : groups) {
    ResidualRow row{std::string(to_string(key.first)), key.second, group.high.bin(), {}};
    for (std::size_t i = 0; i < row.bins.size(); ++i) row.bins[i] = group.bins[i].bin();
    result.push_back(row);
  }
  return result;
}

std::string to_table(const std::vector<ResidualRow>& rows) {
  std::string out =
      format("residuals, rms (mean)   from %.0f deg     count", kResidualElevation_deg);
  for (std::size_t i = 0; i < kResidualElevations.size(); ++i) {
    const double end = i + 1 < kResidualElevations.size() ? kResidualElevations[i + 1] : 90.0;
    out += format("  %8.0f-%.0f deg", kResidualElevations[i], end);
  }
  out += "\n";
  for (const ResidualRow& row : rows) {
    out += format("  %-8s %-8s %7.4f (%7.4f) %9ld", row.system.c_str(), row.observable.c_str(),
                  row.high.rms, row.high.mean, row.high.count);
    for (const ResidualBin& bin : row.bins) {
      out += bin.count > 0 ? format(" %7.4f(%7.4f)", bin.rms, bin.mean) : format("%17s", "-");
    }
    out += "\n";
  }
  return out;
}

}  // namespace leonav
