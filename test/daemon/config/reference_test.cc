// config/reference.yaml names every key with the default and the range that the code has.
#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/navigator/interface/vehicle_defaults.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "same_config.h"
#include "support/catch.h"

namespace {

using namespace leonav;

// One key of the reference: "  NAME: VALUE      # ALLOWED", with its meaning in lines above.
struct ReferenceKey {
  std::string line, path, value, allowed;
  bool explained = false;  // by comment lines directly above
};

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

std::vector<ReferenceKey> keys_of(const std::string& reference) {
  std::vector<ReferenceKey> keys;
  std::vector<std::string> groups;  // of the line before
  bool explained = false;
  std::istringstream stream(reference);
  for (std::string line; std::getline(stream, line);) {
    const std::string text = trimmed(line);
    if (text.empty() || text[0] == '#') {
      explained = !text.empty();
      continue;
    }
    groups.resize(std::min(groups.size(), line.find_first_not_of(' ') / 2));
    std::string path;
    for (const std::string& group : groups) path += group + ".";
    const std::size_t colon = text.find(':');
    if (colon + 1 == text.size()) {
      groups.push_back(text.substr(0, colon));
    } else {
      const std::size_t comment = text.find("  # ");
      REQUIRE(comment != std::string::npos);
      keys.push_back({line, path + text.substr(0, colon),
                      trimmed(text.substr(colon + 1, comment - colon - 1)),
                      text.substr(comment + 4), explained});
    }
    explained = false;
  }
  return keys;
}

// Groups whose keys are those of another group, or all alike, and where their meaning stands.
std::string path_of_meaning(const std::string& path) {
  const std::string bands = "gnss.leo_bands_mhz.";
  if (path.starts_with(bands)) return bands + "1";
  for (const auto& [twin, original] :
       {std::pair("gnss.galileo.", "gnss.gps."), std::pair("gnss.beidou.", "gnss.gps."),
        std::pair("gnss.leo.", "gnss.gps."), std::pair("realtime.ins.", "realtime.io."),
        std::pair("realtime.gnss.", "realtime.io."),
        std::pair("realtime.smoother.", "realtime.io."),
        std::pair("realtime.out.", "realtime.io.")}) {
    if (path.starts_with(twin)) return original + path.substr(std::string(twin).size());
  }
  return path;
}

std::vector<std::string> unexplained(const std::string& reference) {
  const std::vector<ReferenceKey> keys = keys_of(reference);
  std::vector<std::string> paths;
  for (const ReferenceKey& one : keys) {
    const std::string place = path_of_meaning(one.path);
    const bool explained = std::any_of(keys.begin(), keys.end(), [&](const ReferenceKey& other) {
      return other.explained && (other.path == one.path || other.path == place);
    });
    if (!explained) paths.push_back(one.path);
  }
  return paths;
}

}  // namespace

TEST_CASE("the reference has every key of the code, no other, each with its default and range") {
  const std::vector<ReferenceKey> written = keys_of(std::string(reference_text()));
  const std::vector<ConfigKey> read = load_config_text("{}", "defaults").source.keys;
  for (std::size_t i = 0; i < std::min(written.size(), read.size()); ++i) {
    INFO(written[i].line);
    REQUIRE(written[i].path == read[i].path);
    CHECK(written[i].value == read[i].built_in);
    CHECK(written[i].allowed == read[i].allowed);
    CHECK(written[i].line.find("# " + written[i].allowed) >= 46);  // one below the other
  }
  CHECK(written.size() == read.size());
  CHECK(read.size() > 160);
}

TEST_CASE("the reference explains every key, or the key of the group that its group repeats") {
  CHECK(unexplained(std::string(reference_text())) == std::vector<std::string>());
  const std::string groups =
      "# All.\ngnss:\n  # A mask.\n  mask: 1  # a\n  gps:\n    # Bands.\n    bands: 1  # a\n";
  CHECK(unexplained(groups + "  leo:\n    bands: 2  # a\n") == std::vector<std::string>());
  CHECK(unexplained(groups + "ekf:\n  bands: 2  # a\n  mask: 2  # a\n") ==
        std::vector<std::string>{"ekf.bands", "ekf.mask"});
  CHECK(unexplained(groups + "  leo:\n    mask: 2  # a\n    bands: 2  # a\n") ==
        std::vector<std::string>{"gnss.leo.mask"});
}

TEST_CASE("the reference loads as the built-in defaults, field by field") {
  const DaemonConfig reference = load_config_text(std::string(reference_text()), "reference.yaml");
  const DaemonConfig defaults = load_config_text("{}", "defaults");
  CHECK(test::same_config(reference, defaults));
  // One of them stated otherwise is seen.
  const DaemonConfig other =
      load_config_text(std::string(reference_text()), "x", {"alignment.settling_s=20.5"});
  CHECK_FALSE(test::same_config(other, defaults));
}

TEST_CASE("a configuration made by hand is what YAML gives for the same kind of vehicle") {
  const std::pair<const char*, VehicleKind> kinds[] = {{"car", VehicleKind::kCar},
                                                       {"rail", VehicleKind::kRail},
                                                       {"boat", VehicleKind::kBoat},
                                                       {"uav", VehicleKind::kUav},
                                                       {"handheld", VehicleKind::kHandheld}};
  for (const auto& [name, kind] : kinds) {
    INFO(name);
    const auto read = load_config_text(std::string("vehicle: {kind: ") + name + "}", "x");
    CHECK(read.navigator == default_navigator_config(kind));
  }
  CHECK_FALSE(default_navigator_config(VehicleKind::kCar) ==
              default_navigator_config(VehicleKind::kRail));
}
