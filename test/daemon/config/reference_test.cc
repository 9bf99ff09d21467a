// config/reference.yaml names every key with the default and the range that the code has.
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/navigator/interface/vehicle_defaults.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "same_config.h"
#include "support/catch.h"

namespace {

using namespace leonav;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string trimmed(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  return begin == std::string::npos ? "" : line.substr(begin);
}

bool is_explanation(const std::string& line) { return trimmed(line).starts_with("#"); }

std::vector<std::string> keys_in(const std::string& text) {
  std::vector<std::string> keys;
  for (const std::string& line : lines_of(text)) {
    if (!trimmed(line).empty() && !is_explanation(line)) keys.push_back(line);
  }
  return keys;
}

}  // namespace

TEST_CASE("the reference has every key of the code, no other, each with its default and range") {
  const std::vector<std::string> written = keys_in(std::string(reference_text()));
  const std::vector<std::string> read = keys_in(reference_keys());
  for (std::size_t i = 0; i < std::min(written.size(), read.size()); ++i) {
    REQUIRE(written[i] == read[i]);
  }
  CHECK(written.size() == read.size());
  CHECK(read.size() > 160);
}

TEST_CASE("the reference explains every key, or another group's key of the same name") {
  std::map<std::string, bool> explained;
  std::string before;
  for (const std::string& line : lines_of(std::string(reference_text()))) {
    const std::string text = trimmed(line);
    if (!text.empty() && !is_explanation(line)) {
      const std::string key = text.substr(0, text.find(':'));
      INFO(key);
      CHECK((is_explanation(before) || explained[key]));
      explained[key] = true;
    }
    before = line;
  }
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
