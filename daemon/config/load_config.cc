#include "daemon/config/load_config.h"

#include <optional>
#include <utility>

#include "core/navigator/interface/vehicle_defaults.h"
#include "daemon/config/config_file.h"
#include "daemon/config/config_groups.h"
#include "daemon/config/config_reader.h"
#include "daemon/config/internal/yaml_text.h"
#include "daemon/config/presets.h"

namespace leonav {
namespace {

// liblcm subscribes by regular expressions, in which other characters have meanings of their own.
void check_prefix(const ConfigReader& group, const std::string& prefix) {
  for (const char c : prefix) {
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-';
    if (!plain) return group.report("prefix", "only letters, digits, '_' and '-' may be in it");
  }
}

DaemonConfig read_root(ConfigReader& root) {
  DaemonConfig config;
  NavigatorConfig& navigator = config.navigator;
  // What depends on the kind of vehicle is replaced once the kind has been read.
  navigator = default_navigator_config(navigator.vehicle.kind);
  std::optional<std::string> preset;  // its layers are among those that are read
  root.text("preset", &preset, "~ or one of " + preset_names());
  root.choice<Estimator>("estimator",
                         {{"ekf", Estimator::kEkf}, {"smoother", Estimator::kSmoother}},
                         &navigator.estimator);
  root.group("vehicle", [&](ConfigReader& r) { read_vehicle(r, &navigator); });
  root.group("imu", [&](ConfigReader& r) {
    read_imu_stamps(r, &navigator.imu_time_offset_s);
    read_imu(r, &navigator.imu);
  });
  root.group("alignment",
             [&](ConfigReader& r) { read_alignment(r, navigator.vehicle, &navigator.alignment); });
  root.group("gnss", [&](ConfigReader& r) { read_gnss(r, &navigator.gnss); });
  root.group("ekf", [&](ConfigReader& r) { read_ekf(r, &navigator); });
  root.group("smoother", [&](ConfigReader& r) { read_smoother(r, &navigator.smoother); });
  root.group("robust", [&](ConfigReader& r) { read_robust(r, &navigator.ekf.robust); });
  root.group("integrity", [&](ConfigReader& r) { read_integrity(r, &navigator.integrity); });
  root.group("realtime", [&](ConfigReader& r) { read_realtime(r, &navigator, &config.threads); });
  root.group("drill", [&](ConfigReader& r) { read_drill(r, &config.drill); });
  root.group("lcm", [&](ConfigReader& r) {
    read_lcm(r, &config.lcm);
    check_prefix(r, config.lcm.prefix);
  });
  root.group("commands", [&](ConfigReader& r) { read_commands(r, &config.commands); });
  root.group("journal", [&](ConfigReader& r) { read_journal(r, &config.journal); });
  root.group("checkpoint",
             [&](ConfigReader& r) { read_checkpoint(r, &config.checkpoint, &navigator); });
  root.group("log", [&](ConfigReader& r) { read_log(r, &config.log); });
  return config;
}

// Without the preset where there is none of its name, which is noted.
std::vector<ConfigLayer> with_preset(const std::vector<ConfigLayer>& own, ConfigSource* source) {
  std::vector<ConfigLayer> layers;
  try {
    layers = preset_layers(own);
  } catch (const ConfigError& error) {
    source->errors.emplace_back(error.what());
  }
  layers.insert(layers.end(), own.begin(), own.end());
  return layers;
}

DaemonConfig load_layers(ConfigLayer file, const std::vector<std::string>& overrides,
                         const std::vector<ConfigCheck>& checks) {
  ConfigSource source{file.name};
  const std::vector<ConfigLayer> layers =
      with_preset({std::move(file), override_layer(overrides)}, &source);
  DaemonConfig config;
  read_layers(layers, &source, [&](ConfigReader& root) {
    config = read_root(root);
    config.source = {source.name, std::move(source.keys)};
    for (const ConfigCheck& check : checks) root.attempt([&] { check(config); });
  });
  return config;
}

}  // namespace

DaemonConfig load_config(const std::string& path, const std::vector<std::string>& overrides,
                         const std::vector<ConfigCheck>& checks) {
  return load_config_text(read_config_file(path), path, overrides, checks);
}

DaemonConfig load_config_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides,
                              const std::vector<ConfigCheck>& checks) {
  return load_layers(text_layer(text, name), overrides, checks);
}

DaemonConfig load_preset(const std::string& name, const std::vector<std::string>& overrides,
                         const std::vector<ConfigCheck>& checks) {
  find_preset(name, "--preset");
  return load_layers(text_layer("preset: " + name, "preset " + name), overrides, checks);
}

std::string text_override(const std::string& key, const std::string& value) {
  return key + "=" + quoted_text(value);
}

}  // namespace leonav
