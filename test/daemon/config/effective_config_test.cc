// The effective text is the whole configuration: it loads as the same, bit for bit.
#include <string>

#include "core/base/angle.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/internal/yaml_text.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "same_config.h"
#include "support/catch.h"
#include "support/has.h"

namespace {

using namespace leonav;
using test::has;

void check_identity(const DaemonConfig& config) {
  for (const Extent extent : {Extent::kAllKeys, Extent::kChanges}) {
    const std::string text = effective_text(config.source, extent);
    INFO(text);
    const DaemonConfig again = load_config_text(text, "dump");
    CHECK(test::same_config(config, again));
    for (std::size_t i = 0; i < again.source.keys.size(); ++i) {
      const ConfigKey &before = config.source.keys[i], &after = again.source.keys[i];
      if (before.path != "preset") CHECK(before.value == after.value);
    }
  }
}

}  // namespace

TEST_CASE("the effective text of every preset, and of none, loads as the same configuration") {
  check_identity(load_config_text("{}", "defaults"));
  for (const Preset& preset : presets()) check_identity(load_preset(std::string(preset.name)));
}

TEST_CASE("the effective text of unusual values loads as the same configuration") {
  const std::string text =
      "preset: car\n"
      "vehicle: {kind: rail, lever_arm_b_m: [0.1, -1e-7, 33.333333333333336], odometer: false,\n"
      "  constraint_point_b_m: [-1.25, 0, 0.3], zero_velocity: by_kind, estimate_lever_arm: true,\n"
      "  estimate_time_offset: true, mounting_rpy_deg: [0.1, 0.2, 359.99999999999994]}\n"
      "alignment: {initial_heading_deg: 271.7, confirming_s: ~, max_reverse_speed_m_s: "
      "0.30000001}\n"
      "gnss: {systems: [leo, gps], polar_motion_x_arcsec: 0.1, polar_motion_y_arcsec: -0.36,\n"
      "  gps: {attributes: [Y, N, C], second_bands: []}, weight_model: sine}\n"
      "journal: {path: \"a b/\\\"x\\\"\\n~\\t#1\"}\n"
      "lcm: {prefix: \"007\"}\n"
      "checkpoint: {path: \"\", max_age_s: 1e9}\n"
      "realtime: {solution_rate_hz: +0.01, io: {cpu: 3}}\n";
  const DaemonConfig config =
      load_config_text(text, "odd\nname.yaml", {text_override("checkpoint.path", "yes")});
  CHECK(config.checkpoint.path == "yes");
  CHECK(config.lcm.prefix == "007");
  check_identity(config);
}

TEST_CASE("the effective text states where each value is from") {
  const std::string text =
      effective_text(load_config_text("preset: car\nimu:\n  gyro_bias_deg_per_h: 50\n",
                                      "vehicle.yaml", {"gnss.systems=[gps]"})
                         .source);
  CHECK(text.find("# vehicle.yaml on preset car: every key\n") == 0);
  CHECK(has(text, "\nimu:\n  time_offset_ms: 0 "));
  CHECK(has(text, "  gyro_bias_deg_per_h: 50                     # from: vehicle.yaml:3\n"));
  CHECK(has(text, "  systems: [gps]                              # from: --set\n"));
  CHECK(
      has(text,
          "  non_holonomic: by_kind                      # true, from: default of vehicle.kind\n"));
  CHECK(has(text, "  kind: car                                   # from: preset car:"));
  CHECK_FALSE(has(text, "preset:"));
  const std::string changes =
      effective_text(load_config_text("imu: {gyro_bias_deg_per_h: 50, accel_bias_mgal: 20000}\n",
                                      "vehicle.yaml", {})
                         .source,
                     Extent::kChanges);
  CHECK(changes ==
        "# vehicle.yaml: keys that differ from the defaults\nimu:\n"
        "  gyro_bias_deg_per_h: 50                     # from: vehicle.yaml:1\n");
  CHECK(effective_text(load_config_text("{}", "x").source, Extent::kChanges) ==
        "# x: keys that differ from the defaults\n{}\n");
}

TEST_CASE("what depends on another key follows an override of that key in the effective text") {
  const DaemonConfig handheld = load_config_text("vehicle: {odometer: false}", "x");
  const std::string text = effective_text(handheld.source);
  CHECK(has(text, "  odometer: false                             # from: x:1\n"));
  const DaemonConfig car = load_config_text(text, "dump", {"vehicle.kind=car"});
  CHECK(test::same_config(car, load_config_text("vehicle: {kind: car, odometer: false}", "x")));
  CHECK_FALSE(car.navigator.vehicle.motion.constraints.odometer);
  const auto moved = load_config_text(text, "dump", {"vehicle.constraint_point_b_m=[1, 2, 3]"});
  CHECK(moved.navigator.vehicle.motion.constraints.odometer_point_b == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("a number is the shortest decimal of the same bits, in the unit of the file too") {
  CHECK(number_text(0.1) == "0.1");
  CHECK(number_text(2592000.0) == "2592000");
  CHECK(number_text(-0.0) == "-0");
  CHECK(number_text(1e-9) == "1e-09");
  CHECK(number_text(1.0 / 3.0) == "0.3333333333333333");
  CHECK(number_text(0.573 * kDegree, kDegree) == "0.573");
  CHECK(number_text(1000.0 * (kDegree / 3600.0), kDegree / 3600.0) == "1000");
  CHECK(plain_text("LEONAV_") == "LEONAV_");
  CHECK(plain_text("no") == "\"no\"");
  CHECK(plain_text("007") == "\"007\"");
  CHECK(plain_text("") == "\"\"");
  CHECK(list_text({"C", "Y", "a b"}) == "[C, \"Y\", \"a b\"]");
  CHECK(alternatives({"a", "b", "c"}) == "a, b or c");
}
