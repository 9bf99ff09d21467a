#include "daemon/config/load_config.h"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "daemon/config/config_groups.h"
#include "daemon/config/config_reader.h"

namespace leonav {
namespace {

std::string read_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ConfigError(path + ": is a directory, not a configuration file");
  }
  std::ifstream file(path);
  if (!file) {
    throw ConfigError(path + ": cannot be opened: " + std::strerror(errno) +
                      "; config/ has an example for each kind of vehicle");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

void apply_override(const std::string& text, YAML::Node root) {
  const auto equals = text.find('=');
  const std::string path = text.substr(0, equals);
  const std::vector<std::string> keys = split_path(path);
  bool good = equals != std::string::npos && !keys.empty();
  for (const std::string& key : keys) good = good && !key.empty();
  if (!good) throw ConfigError("--set " + text + ": expected group.key=value");
  // A journal holds one override in a line.
  if (text.find('\n') != std::string::npos)
    throw ConfigError("--set " + path + ": more than a line");
  YAML::Node value;
  try {
    value = YAML::Load(text.substr(equals + 1));
  } catch (const YAML::Exception& error) {
    throw ConfigError("--set " + path + ": " + error.msg);
  }
  YAML::Node node = root;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    YAML::Node child = node[keys[i]];
    if (child.IsDefined() && !child.IsNull() && !child.IsMap()) {
      throw ConfigError("--set " + path + ": '" + keys[i] + "' is not a group");
    }
    node.reset(child);
  }
  // Built anew, so that errors name --set and not the line of the text given with it.
  if (value.IsSequence()) {
    YAML::Node copy(YAML::NodeType::Sequence);
    for (const YAML::Node& element : value) {
      copy.push_back(element.IsScalar() ? YAML::Node(element.Scalar()) : element);
    }
    node[keys.back()] = copy;
  } else if (value.IsScalar()) {
    node[keys.back()] = YAML::Node(value.Scalar());
  } else if (value.IsNull()) {
    node[keys.back()] = YAML::Node(YAML::NodeType::Null);
  } else {
    throw ConfigError("--set " + path + ": set one key at a time");
  }
}

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
  int estimator = 0;
  root.choice<int>("estimator", {{"ekf", 0}}, &estimator);
  root.group("vehicle", [&](ConfigReader& r) { read_vehicle(r, &navigator.vehicle); });
  root.group("imu", [&](ConfigReader& r) { read_imu(r, &navigator.imu); });
  root.group("alignment", [&](ConfigReader& r) { read_alignment(r, &navigator.alignment); });
  root.group("gnss", [&](ConfigReader& r) { read_gnss(r, &navigator.gnss); });
  root.group("ekf", [&](ConfigReader& r) { read_ekf(r, &navigator); });
  root.group("robust", [&](ConfigReader& r) { read_robust(r, &navigator.ekf.robust); });
  root.group("realtime", [&](ConfigReader& r) { read_realtime(r, &navigator, &config.threads); });
  root.group("lcm", [&](ConfigReader& r) {
    read_lcm(r, &config.lcm);
    check_prefix(r, config.lcm.prefix);
  });
  root.group("journal", [&](ConfigReader& r) { read_journal(r, &config.journal); });
  root.finish();
  return config;
}

}  // namespace

DaemonConfig load_config(const std::string& path, const std::vector<std::string>& overrides,
                         std::vector<std::string>* absent) {
  return load_config_text(read_file(path), path, overrides, absent);
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
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      throw ConfigError(
          name + ":" + std::to_string(documents[1].Mark().line + 1) +
          ": a second document begins here ('---'), which would not be read; keep one");
    }
    YAML::Node root = documents.empty() ? YAML::Node() : documents[0];
    if (root.IsNull()) throw ConfigError(name + ": is empty; config/ has examples");
    if (!root.IsMap()) throw ConfigError(name + ":1: expected groups of keys");
    for (const std::string& text_of_one : overrides) apply_override(text_of_one, root);
    ConfigSource source{name, {}, {}};
    ConfigReader reader(&source, root, "");
    DaemonConfig config = read_root(reader);
    config.source = {name, text, overrides};
    auto& recorded = config.source.overrides;
    recorded.insert(recorded.end(), source.resolved.begin(), source.resolved.end());
    if (absent != nullptr) *absent = source.absent;
    return config;
  } catch (const YAML::Exception& error) {
    throw ConfigError(name + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

}  // namespace leonav
