#include "daemon/config/load_config.h"

#include "daemon/config/config_file.h"
#include "daemon/config/config_groups.h"
#include "daemon/config/config_reader.h"

namespace leonav {
namespace {

// A consumer MEMS sensor: to take too poor an IMU is slow, to take too good a one is wrong.
ImuErrorModel default_imu() {
  constexpr double kDegree = 0.017453292519943295;
  ImuErrorModel imu;
  imu.angle_random_walk = 0.3 * kDegree / 60.0;
  imu.velocity_random_walk = 0.1 / 60.0;
  imu.gyro_bias = {1000.0 * kDegree / 3600.0, 1000.0};
  imu.accel_bias = {20000.0e-5, 1000.0};
  imu.gyro_scale = {5000.0e-6, 10000.0};
  imu.accel_scale = {5000.0e-6, 10000.0};
  return imu;
}

// liblcm subscribes by regular expressions, in which other characters have meanings of their own.
void check_prefix(const ConfigReader& group, const std::string& prefix) {
  for (const char c : prefix) {
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-';
    if (!plain) group.fail("prefix", "only letters, digits, '_' and '-' may be in it");
  }
}

DaemonConfig read_root(ConfigReader& root) {
  DaemonConfig config;
  NavigatorConfig& navigator = config.navigator;
  navigator.gnss = default_gnss_config();
  navigator.imu = default_imu();
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
  root.group("realtime", [&](ConfigReader& r) { read_realtime(r, &navigator, &config.threads); });
  root.group("drill", [&](ConfigReader& r) { read_drill(r, &config.drill); });
  root.group("lcm", [&](ConfigReader& r) {
    read_lcm(r, &config.lcm);
    check_prefix(r, config.lcm.prefix);
  });
  root.group("journal", [&](ConfigReader& r) { read_journal(r, &config.journal); });
  root.group("checkpoint",
             [&](ConfigReader& r) { read_checkpoint(r, &config.checkpoint, &navigator); });
  return config;
}

}  // namespace

DaemonConfig load_config(const std::string& path, const std::vector<std::string>& overrides,
                         std::vector<std::string>* absent) {
  return load_config_text(read_config_file(path), path, overrides, absent);
}

std::string text_override(const std::string& key, const std::string& value) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string text = key + "=\"";
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      text += {'\\', 'x', kHex[byte >> 4], kHex[byte & 0xf]};
    } else {
      if (c == '"' || c == '\\') text += '\\';
      text += c;
    }
  }
  return text + "\"";
}

DaemonConfig load_config_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides,
                              std::vector<std::string>* absent) {
  ConfigSource source{name, {}, {}};
  DaemonConfig config;
  read_yaml(text, overrides, &source, [&](ConfigReader& root) { config = read_root(root); });
  config.source = {name, text, overrides};
  auto& recorded = config.source.overrides;
  recorded.insert(recorded.end(), source.resolved.begin(), source.resolved.end());
  if (absent != nullptr) *absent = source.absent;
  return config;
}

}  // namespace leonav
