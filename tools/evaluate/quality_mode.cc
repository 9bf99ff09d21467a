#include "tools/evaluate/quality_mode.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <stdexcept>

#include "tools/quality/quality.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlotEpochs = 5000;

// Runs the plot script in the folder of this program, with the program's output streams.
void draw(const fs::path& folder) {
  const fs::path script = fs::read_symlink("/proc/self/exe").parent_path() / "leonav-quality-plots";
  std::cout.flush();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process for the plots");
  if (child == 0) {
    ::execl(script.c_str(), script.c_str(), folder.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw std::runtime_error(script.string() + " cannot be run; the tables are in " +
                             folder.string());
  throw std::runtime_error("the plots failed; the tables are in " + folder.string());
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
  const bool plots = arguments.has("--plots");
  if (plots) options.plot_epochs = kPlotEpochs;
  const fs::path folder = arguments.get("--plots");
  if (plots) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
      throw std::runtime_error(folder.string() + ": no folder, and cannot be made");
  }
  const Quality quality = analyse_quality(arguments.positional()[0], options, &std::cerr);
  std::cout << to_table(quality);
  if (arguments.has("--json")) {
    std::ofstream file(arguments.get("--json"));
    file << to_json(quality);
    if (!file.flush()) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  if (plots) {
    write_plot_tables(quality, folder.string());
    draw(folder);
  }
  return 0;
}

}  // namespace leonav
