#include "tools/common/configuration_options.h"

#include "daemon/config/presets.h"

namespace leonav {

void add_configuration_options(Arguments* arguments) {
  arguments
      ->option("--config", "FILE",
               "configuration; leonavd --reference prints every key it may have")
      .option("--preset", "NAME", "instead: a preset alone; one of " + preset_names())
      .option("--set", "KEY=VALUE",
              "override one configuration key, as in gnss.systems=[gps]; may be repeated");
}

bool has_configuration(const Arguments& arguments) {
  if (arguments.has("--config") && arguments.has("--preset")) {
    throw UsageError(
        "--config and --preset exclude each other; a file names its preset itself (preset: NAME)");
  }
  return arguments.has("--config") || arguments.has("--preset");
}

DaemonConfig load_configuration(const Arguments& arguments,
                                const std::vector<std::string>& overrides,
                                const std::vector<ConfigCheck>& checks) {
  std::vector<std::string> all = arguments.all("--set");
  all.insert(all.end(), overrides.begin(), overrides.end());
  if (!has_configuration(arguments)) {
    throw UsageError("--config is missing; give --config FILE or --preset NAME (" +
                     arguments.program() + " --help)");
  }
  if (arguments.has("--preset")) return load_preset(arguments.get("--preset"), all, checks);
  return load_config(arguments.required("--config"), all, checks);
}

}  // namespace leonav
