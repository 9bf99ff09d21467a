// Presets stand between the built-in defaults and a file; the command line stands above all.
#include <algorithm>
#include <string>

#include "config_error.h"
#include "daemon/config/config_file.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "same_config.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using leonav::test::error_of;

const ConfigKey& key_of(const DaemonConfig& config, const std::string& path) {
  const auto& keys = config.source.keys;
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const ConfigKey& one) { return one.path == path; });
  REQUIRE(found != keys.end());
  return *found;
}

std::string origin_of(const DaemonConfig& config, const std::string& path) {
  return key_of(config, path).origin;
}

}  // namespace

TEST_CASE("default, preset, file and command line take precedence in this order") {
  const std::string text =
      "preset: walk\nalignment:\n  levelling_sigma_deg: 7\n  max_course_sigma_deg: 30\n";
  const DaemonConfig config = load_config_text(text, "mine.yaml", {"alignment.settling_s=9"});
  CHECK(config.navigator.alignment.settling_s == 9.0);
  CHECK(key_of(config, "alignment.levelling_sigma_deg").value == "7");
  CHECK(config.navigator.alignment.min_course_speed_m_s == 0.7);
  CHECK(config.threads.ins.priority == 60);
  CHECK(origin_of(config, "alignment.settling_s") == "--set");
  CHECK(origin_of(config, "alignment.max_course_sigma_deg") == "mine.yaml:4");
  CHECK(origin_of(config, "alignment.min_course_speed_m_s").find("preset walk:") == 0);
  CHECK(origin_of(config, "realtime.ins.priority").find("preset realtime:") == 0);
  CHECK(origin_of(config, "alignment.turning_arm_m") == "default");
  CHECK(origin_of(config, "alignment.confirming_s") == "default of vehicle.kind");
  CHECK(origin_of(config, "vehicle.odometer_point_b_m") ==
        "default of vehicle.constraint_point_b_m");
}

TEST_CASE("a preset may be chosen by the command line, and alone") {
  CHECK(test::same_config(load_config_text("preset: station\n", "x", {"preset=walk"}),
                          load_preset("walk")));
  CHECK(test::same_config(load_config_text("{}", "x", {"preset=walk"}), load_preset("walk")));
  CHECK(test::same_config(load_preset("walk", {"preset=urban"}), load_preset("urban")));
  CHECK(test::same_config(load_config_text("preset: ~\n", "x"), load_config_text("{}", "x")));
  CHECK_FALSE(test::same_config(load_preset("walk"), load_preset("urban")));
  CHECK(load_preset("car").source.name == "preset car");
}

TEST_CASE("an unknown preset is refused with its line, the nearest name and all names") {
  CHECK(error_of("vehicle: {}\npreset: carr\n") ==
        "car.yaml:2: preset: unknown preset 'carr'; did you mean 'car'? presets: " +
            preset_names());
  CHECK(error_of("preset: submarine\n").find("unknown preset 'submarine'; presets: car, ") !=
        std::string::npos);
  CHECK(error_of("{}", {"preset=wlak"}).find("--set preset: unknown preset 'wlak'; did you") == 0);
  CHECK(error_of("preset: [car, walk]\n") == "car.yaml:1: preset: expected a text");
  CHECK(error_of("preset: car\npreset: walk\n") == "car.yaml:2: preset: given twice; remove one");
  CHECK_THROWS_WITH(load_preset("wlak"), Catch::StartsWith("--preset: unknown preset 'wlak'"));
}

TEST_CASE("an error in the file is reported at the file, on a preset as well") {
  CHECK(error_of("preset: car\ngnss:\n  gps: {code_sigma_m: ten}\n") ==
        "car.yaml:3: gnss.gps.code_sigma_m: 'ten' is not a number");
  CHECK(error_of("preset: car\ngnss:\n  sistems: [gps]\n").find("car.yaml:3: gnss.sistems") == 0);
  CHECK(error_of("preset: car\nrobust:\n  k1: 1\n") ==
        "car.yaml:3: robust.k1: must be greater than k0");
  CHECK(error_of("preset: car\nrobust:\n  k0: 9\n") ==
        "car.yaml:3: robust.k1: must be greater than k0");
  CHECK(error_of("preset: car\n", {"gnss=~"}) == "--set gnss: set one key at a time");
}

TEST_CASE("a group that a file leaves empty keeps the preset's values") {
  const DaemonConfig config = load_config_text("preset: walk\ngnss:\nekf:\n", "x");
  CHECK(config.navigator.gnss.cn0_mask_dbhz == 20.0);
}

TEST_CASE("a preset states only what differs from its base, or from the defaults") {
  CHECK(presets().size() >= 8);
  for (const Preset& preset : presets()) {
    const std::string name(preset.name);
    const DaemonConfig config = load_preset(name);
    const ConfigLayer own = text_layer(std::string(preset.text), name);
    const bool has_base = own.root["preset"].IsDefined();
    const DaemonConfig base =
        has_base ? load_preset(own.root["preset"].Scalar()) : load_config_text("{}", "defaults");
    int stated = 0;
    for (const ConfigKey& key : config.source.keys) {
      if (key.path == "preset" || key.origin.find("preset " + name + ":") != 0) continue;
      INFO(name << " " << key.path);
      CHECK(key.value != key_of(base, key.path).value);
      ++stated;
    }
    CHECK(stated >= 5);
  }
  CHECK(load_preset("car").navigator.vehicle.kind == VehicleKind::kCar);
}
