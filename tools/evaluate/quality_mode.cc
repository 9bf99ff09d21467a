#include "tools/evaluate/quality_mode.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "tools/evaluate/internal/plot_script.h"
#include "tools/quality/quality.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlotEpochs = 5000;

// Reads carriers by band, "9=2492.028,3=5020.5" in MHz, as gnss.leo_bands_mhz of the configuration.
BandPlan read_bands(const std::string& text) {
  BandPlan plan;
  std::istringstream entries(text);
  for (std::string entry; std::getline(entries, entry, ',');) {
    std::istringstream parts(entry);
    char band = 0, equals = 0;
    double mhz = 0.0;
    parts >> band >> equals >> mhz;
    const double hz = std::round(mhz * 1e7) / 10.0;
    if (!parts || !parts.eof() || equals != '=' || !is_band_of(System::kLeo, band) ||
        !(hz >= BandPlan::kLowest_hz && hz <= BandPlan::kHighest_hz)) {
      throw UsageError("--leo-bands: '" + entry +
                       "' is not BAND=MHZ with a band 1 to 9 and 1000 to 8000 MHz, as 9=2492.028");
    }
    for (char other = BandPlan::kFirstBand; other <= BandPlan::kLastBand; ++other) {
      if (other != band && plan.frequency_hz(System::kLeo, other) == hz)
        throw UsageError("--leo-bands: '" + entry + "' is also the carrier of band " + other);
    }
    plan.set_leo(band, hz);
  }
  return plan;
}

}  // namespace

int run_quality(const Arguments& arguments) {
  for (const char* name : {"--truth", "--imu", "--from", "--to", "--remove-offset"}) {
    if (arguments.has(name))
      throw UsageError(std::string(name) + " judges solutions; it goes not with --quality");
  }
  if (arguments.positional().size() != 1)
    throw UsageError("--quality takes one log (run.lcmlog or a journal)");
  QualityOptions options;
  options.prefix = arguments.get("--prefix");
  const double mask_deg = arguments.number("--mask");
  if (!(mask_deg >= 0.0 && mask_deg < 90.0)) throw UsageError("--mask must be within 0 and 90");
  options.elevation_mask = mask_deg * std::numbers::pi / 180.0;
  if (arguments.has("--leo-bands")) options.bands = read_bands(arguments.get("--leo-bands"));
  const bool plots = arguments.has("--plots");
  if (plots) options.plot_epochs = kPlotEpochs;
  const fs::path folder = plots ? make_plot_folder(arguments.get("--plots")) : fs::path();
  const Quality quality = analyse_quality(arguments.positional()[0], options, &std::cerr);
  std::cout << to_table(quality);
  if (arguments.has("--json")) {
    std::ofstream file(arguments.get("--json"));
    file << to_json(quality);
    if (!file.flush()) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  if (plots) {
    write_plot_tables(quality, folder.string());
    run_plot_script("leonav-quality-plots", {folder.string()}, folder);
  }
  return 0;
}

}  // namespace leonav
