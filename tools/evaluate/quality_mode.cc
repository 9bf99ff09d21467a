#include "tools/evaluate/quality_mode.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <stdexcept>

#include "tools/evaluate/internal/plot_script.h"
#include "tools/quality/quality.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlotEpochs = 5000;

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
