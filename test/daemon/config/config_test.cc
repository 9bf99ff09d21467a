// Every way to get the configuration wrong names its place and the remedy.
#include <algorithm>

#include "config_error.h"
#include "daemon/config/load_config.h"
#include "drivers/lcm/channels.h"
#include "support/catch.h"

namespace {

using leonav::ConfigError;
using leonav::load_config;
using leonav::load_config_text;
using leonav::text_override;
using leonav::test::error_of;

}  // namespace

TEST_CASE("a wrong configuration is refused with file, line and remedy") {
  CHECK(error_of("gnss:\n  elevation_mask_dg: 10\n") ==
        "car.yaml:2: gnss.elevation_mask_dg: unknown key; did you mean 'elevation_mask_deg'?");
  CHECK(error_of("gnss:\n  elevation_mask_deg: ten\n") ==
        "car.yaml:2: gnss.elevation_mask_deg: 'ten' is not a number");
  CHECK(error_of("gnss:\n\n  elevation_mask_deg: 95\n") ==
        "car.yaml:3: gnss.elevation_mask_deg: 95 is out of range; must be between -90 and 90");
  CHECK(error_of("gnss: 3\n") ==
        "car.yaml:1: gnss: expected a group of keys (\"key: value\" lines)");
  CHECK(error_of("gnss:\n  systems: [gps, glonass]\n") ==
        "car.yaml:2: gnss.systems: 'glonass' is not one of gps, galileo, beidou, leo");
  CHECK(error_of("gnss:\n  systems: []\n") ==
        "car.yaml:2: gnss.systems: name at least one of gps, galileo, beidou, leo");
  for (const char* prefix : {"CAR.", "(A|B)_", "CAR*", "CAR 1_"}) {
    INFO(prefix);
    CHECK(error_of("lcm:\n  prefix: \"" + std::string(prefix) + "\"\n") ==
          "car.yaml:2: lcm.prefix: only letters, digits, '_' and '-' may be in it");
  }
  CHECK(load_config_text("lcm:\n  prefix: Car-1_\n", "x").lcm.prefix == "Car-1_");
  // With it the longest name, CORRECTED_STATES, is as long as liblcm allows.
  const std::string longest(63 - leonav::name_of(leonav::Channel::kCorrectedStates).size(), 'C');
  CHECK(load_config_text("lcm:\n  prefix: " + longest + "\n", "x").lcm.prefix == longest);
  CHECK(error_of("lcm:\n  prefix: " + longest + "C\n") ==
        "car.yaml:2: lcm.prefix: longer than 47 characters");
  CHECK(error_of("robust:\n  k0: 5\n  k1: 2\n") ==
        "car.yaml:3: robust.k1: must be greater than k0");
  CHECK(error_of("robust:\n  k0: 1\n  k0: 2\n").find("given twice") != std::string::npos);
  CHECK(error_of("ekf:\n  motion: sideways\n").find("inertial, constant_velocity") !=
        std::string::npos);
  CHECK(error_of("ekf:\n  reset_epochs: 2.5\n").find("whole number") != std::string::npos);
  CHECK(error_of("imu:\n  gyro_bias_deg_per_h: .nan\n").find("not a number") != std::string::npos);
  CHECK(error_of("vehicle:\n  lever_arm_b_m: [1, 2]\n").find("[x, y, z]") != std::string::npos);
  CHECK(error_of("lcm:\n  url: \"tcpq://host\"\n").find("car.yaml:2: lcm.url") == 0);
  CHECK(error_of("gnss:\n  gps: [\n").find("car.yaml:") == 0);
  CHECK(error_of("gnss:\n  elevation_mask_deg: 9\n---\nlcm:\n  prefix: A_\n")
            .find("car.yaml:3: a second document begins here") == 0);
  CHECK(error_of("").find("empty") != std::string::npos);
  CHECK_THROWS_AS(load_config("absent.yaml"), ConfigError);
  CHECK_THROWS_AS(load_config(LEONAV_SOURCE_DIR), ConfigError);
}

TEST_CASE("all errors of a configuration are told at once, each in a line and once") {
  CHECK(
      error_of(
          "gnss:\n  elevation_mask_deg: high\n  cn0_mask_dbh: 3\nekf:\n  reset_epochs: 2.5\nlcm:\n"
          "  prefix: 'A B'\njournal: [1]\n") ==
      "car.yaml:2: gnss.elevation_mask_deg: 'high' is not a number\n"
      "car.yaml:3: gnss.cn0_mask_dbh: unknown key; did you mean 'cn0_mask_dbhz'?\n"
      "car.yaml:5: ekf.reset_epochs: must be a whole number\n"
      "car.yaml:7: lcm.prefix: only letters, digits, '_' and '-' may be in it\n"
      "car.yaml:8: journal: expected a group of keys (\"key: value\" lines)");
}

TEST_CASE("what contradicts within a group hides neither the rest of it nor its unknown keys") {
  CHECK(error_of("journal: {path: x, total_mb: 10, kept_mb: 10, piece_md: 5}\n"
                 "robust: {k0: 5, k1: 1, foo: 1}\n"
                 "lcm: {url: \"\", prefixx: x}\n") ==
        "car.yaml:2: robust.k1: must be greater than k0\n"
        "car.yaml:2: robust.foo: unknown key; known here: enabled, k0, k1, max_iterations\n"
        "car.yaml:3: lcm.url: must not be empty\n"
        "car.yaml:3: lcm.prefixx: unknown key; did you mean 'prefix'?\n"
        "car.yaml:1: journal.total_mb: must be at least twice piece_mb, or 0\n"
        "car.yaml:1: journal.kept_mb: must be at least twice piece_mb, or 0\n"
        "car.yaml:1: journal.piece_md: unknown key; did you mean 'piece_mb'?");
  const std::string gnss = error_of(
      "gnss: {systems: [foo, gps, gps], elevation_mask_deg: 500, cn0_mask_dbhz: 999, nonsense: 1,\n"
      "  gps: {first_band: x, second_bands: [x, 5, 5], code_sigma_m: -1},\n"
      "  polar_motion_x_arcsec: 0.1, ocean_loading_station: here, nonsense: 2}\n");
  for (const char* wrong :
       {"1: gnss.systems: 'foo' is not one of", "1: gnss.systems: 'gps' is given twice",
        "1: gnss.elevation_mask_deg: 500 is out of range", "1: gnss.cn0_mask_dbhz: 999 is out of",
        "1: gnss.nonsense: unknown key", "2: gnss.gps.first_band: must be one RINEX band digit",
        "2: gnss.gps.second_bands: 'x' is not one", "2: gnss.gps.second_bands: '5' is given twice",
        "2: gnss.gps.code_sigma_m: -1 is out of range", "3: gnss.polar_motion_x_arcsec: is given",
        "3: gnss.ocean_loading_station: is of no use", "3: gnss.nonsense: unknown key"})
    CHECK_THAT(gnss, Catch::Contains(std::string("car.yaml:") + wrong));
  CHECK(std::count(gnss.begin(), gnss.end(), '\n') == 11);
}

TEST_CASE("an unknown preset hides no other error, and checks for a use are told with the rest") {
  const auto refuse = [](const leonav::DaemonConfig& config) {
    throw ConfigError(config.source.place_of("log.level") + ": not for this use");
  };
  CHECK_THROWS_WITH(
      load_config_text("preset: cart\nlog: {level: info}\nekf: {reset_epoch: 1}\n", "car.yaml", {},
                       {refuse, refuse}),
      Catch::StartsWith("car.yaml:1: preset: unknown preset 'cart'; did you mean 'car'?") &&
          Catch::Contains("car.yaml:3: ekf.reset_epoch: unknown key") &&
          Catch::Contains("\ncar.yaml:2: log.level: not for this use"));
}

TEST_CASE("signals without an atmosphere are said so by name") {
  const auto has_atmosphere = [](const std::string& gnss) {
    return load_config_text("gnss: {" + gnss + "}\n", "x").navigator.gnss.has_atmosphere;
  };
  CHECK(has_atmosphere(""));
  CHECK(has_atmosphere("atmosphere: standard"));
  CHECK_FALSE(has_atmosphere("atmosphere: none"));
  CHECK(error_of("gnss:\n  atmosphere: off\n") ==
        "car.yaml:2: gnss.atmosphere: 'off' is not one of standard, none");
}

TEST_CASE("how LEO satellites stand is read by name") {
  const auto law = [](const std::string& name) {
    return load_config_text("gnss:\n  leo_attitude: " + name + "\n", "x")
        .navigator.gnss.leo_attitude;
  };
  CHECK(load_config_text("gnss: {}\n", "x").navigator.gnss.leo_attitude ==
        leonav::AttitudeLaw::kOrbitNormal);
  CHECK(law("orbit_normal") == leonav::AttitudeLaw::kOrbitNormal);
  CHECK(law("yaw_steering") == leonav::AttitudeLaw::kYawSteering);
  const std::string error = error_of("gnss:\n  leo_attitude: upright\n");
  CHECK(error.find("car.yaml:2: gnss.leo_attitude: ") == 0);
  CHECK(error.find("orbit_normal, yaw_steering") != std::string::npos);
}

TEST_CASE("carriers of LEO satellites are configured by band") {
  using leonav::System;
  const auto gnss = [](const std::string& keys) {
    return load_config_text("gnss:\n" + keys, "x").navigator.gnss;
  };
  CHECK(gnss("  elevation_mask_deg: 9\n").bands == leonav::BandPlan());
  const leonav::BandPlan bands = gnss(
                                     "  leo_bands_mhz: {1: ~, 9: 2492.028, 3: 5020.5}\n  leo: "
                                     "{first_band: 9, second_bands: [3]}\n")
                                     .bands;
  CHECK(bands.frequency_hz(System::kLeo, '9') == 2492.028e6);
  CHECK(bands.frequency_hz(System::kLeo, '3') == 5020.5e6);
  CHECK(bands.frequency_hz(System::kLeo, '1') == 0.0);
  CHECK(bands.frequency_hz(System::kLeo, '2') == 1227.6e6);  // not given: as before
  CHECK(bands.frequency_hz(System::kGps, '1') == 1575.42e6);
  CHECK(error_of("gnss:\n  leo_bands_mhz:\n    9: 12000\n") ==
        "car.yaml:3: gnss.leo_bands_mhz.9: 12000 is out of range; must be between 1000 and 8000");
  CHECK(error_of("gnss:\n  leo_bands_mhz:\n    9: 2.492e9\n").find("between 1000 and 8000") !=
        std::string::npos);
  CHECK(error_of("gnss:\n  leo_bands_mhz:\n    C: 5020.5\n")
            .find("car.yaml:3: gnss.leo_bands_mhz.C: unknown key") == 0);
  CHECK(error_of("gnss:\n  leo_bands_mhz:\n    9: 1575.42\n") ==
        "car.yaml:3: gnss.leo_bands_mhz.9: is also the carrier of band 1; give it to one band and "
        "~ to the other");
  CHECK(error_of("gnss:\n  leo:\n    first_band: 9\n") ==
        "car.yaml:3: gnss.leo.first_band: names band 9, which has no carrier: give "
        "gnss.leo_bands_mhz.9 in MHz, or name a band that has one");
  CHECK(error_of("gnss:\n  leo:\n    second_bands: [2, 3]\n").find("gnss.leo_bands_mhz.3") !=
        std::string::npos);
  // Where LEO is not used, nobody needs its bands.
  CHECK_NOTHROW(gnss("  systems: [gps]\n  leo_bands_mhz: {1: ~}\n"));
}

TEST_CASE("lever arm and time offset are estimated where that is asked for") {
  using namespace leonav::ekf_index;
  const auto load = [](const std::string& text) { return load_config_text(text, "x").navigator; };
  CHECK_FALSE(load("vehicle: {kind: car}\n").ekf.vehicle.moves_antenna());
  CHECK(load("imu: {time_offset_ms: -12.5}\n").imu_time_offset_s == Approx(-0.0125));
  const auto arm =
      load("vehicle: {estimate_lever_arm: true, lever_arm_sigma_m: 0.3}\n").ekf.vehicle;
  CHECK(arm.count == kMaxVehicle);
  CHECK(arm.sigma[kLeverArm + 2] == 0.3);
  CHECK(arm.sigma[kTimeOffset] == 0.0);
  CHECK(arm.sigma[kTravelYaw] == 0.0);  // handheld: nothing tells of it
  const auto offset = load("vehicle: {kind: car, estimate_time_offset: true}\n").ekf.vehicle;
  CHECK(offset.count == kMaxVehicle);
  CHECK(offset.sigma[kTimeOffset] == Approx(0.01));
  CHECK(offset.sigma[kLeverArm] == 0.0);
  CHECK(offset.sigma[kTravelYaw] > 0.0);
}

TEST_CASE("overrides are judged like the file") {
  const std::string text = "gnss:\n  elevation_mask_deg: 10\n";
  const auto config = load_config_text(
      text, "x", {"gnss.systems=[gps]", "robust.enabled=false", "gnss.gps.max_satellites=5"});
  CHECK(config.navigator.gnss.systems[0].enabled);
  CHECK_FALSE(config.navigator.gnss.systems[1].enabled);
  CHECK(config.navigator.gnss.systems[0].max_satellites == 5);
  CHECK_FALSE(config.navigator.ekf.robust.enabled);
  CHECK(config.navigator.gnss.elevation_mask == Approx(10 * 3.14159265358979 / 180));
  CHECK(error_of(text, {"gnss.sistems=[gps]"}).find("--set gnss.sistems: unknown key") == 0);
  CHECK(error_of(text, {"gnss.elevation_mask_deg=200"}).find("--set gnss.elevation") == 0);
  CHECK(error_of(text, {"nonsense"}).find("group.key=value") != std::string::npos);
}

TEST_CASE("a text given as an override arrives as it is, and is judged") {
  const std::string text = "journal:\n  path: from_file\n";
  for (const std::string path :
       {"", "plain.journal", "a: b", "~", "[x]", "it's", "say \"so\"", "back\\slash", "two\nlines",
        "tab\there", "#1", "caf\xc3\xa9", "\xff\x04", " blank "}) {
    INFO(path);
    const std::string one = text_override("journal.path", path);
    CHECK(one.find('\n') == std::string::npos);
    CHECK(load_config_text(text, "x", {one}).journal.path == path);
  }
  CHECK(error_of(text, {text_override("lcm.url", "tcpq://host")}).find("--set lcm.url: tcpq") == 0);
  CHECK(error_of(text, {text_override("lcm.url", "")}) == "--set lcm.url: must not be empty");
  for (const char* url : {"udpm://10.0.0.1:7667", "udpm://host?ttl=1", "udpm://240.0.0.1"}) {
    INFO(url);
    CHECK_THAT(
        error_of(text, {text_override("lcm.url", url)}),
        Catch::StartsWith("--set lcm.url: '") && Catch::Contains("is not a multicast address"));
  }
  for (const char* url : {"udpm://", "udpm://?ttl=0", "udpm://239.1.2.3", "memq://"}) {
    CHECK(load_config_text(text, "x", {text_override("lcm.url", url)}).lcm.url == url);
  }
  CHECK(error_of(text, {"gnss.systems=[gps,\ngalileo]"}) == "--set gnss.systems: more than a line");
}

TEST_CASE("data-sheet units become SI") {
  const auto imu = load_config_text(
                       "imu:\n  angle_random_walk_deg_per_sqrt_h: 0.6\n"
                       "  velocity_random_walk_m_s_per_sqrt_h: 0.06\n"
                       "  gyro_bias_deg_per_h: 3600\n  accel_bias_mgal: 100000\n"
                       "  gyro_scale_ppm: 1000\n",
                       "x")
                       .navigator.imu;
  CHECK(imu.angle_random_walk == Approx(0.01 * 3.14159265358979 / 180));
  CHECK(imu.velocity_random_walk == Approx(0.001));
  CHECK(imu.gyro_bias.sigma == Approx(3.14159265358979 / 180));
  CHECK(imu.accel_bias.sigma == Approx(1.0));
  CHECK(imu.gyro_scale.sigma == Approx(1e-3));
}

TEST_CASE("a found attitude wanders while it settles, but for who walks, unless said otherwise") {
  const auto degrees = [](const std::string& text) {
    return load_config_text(text, "x").navigator.alignment.settling_random_walk * 180.0 /
           3.14159265358979;
  };
  CHECK(degrees("vehicle: {kind: car}\n") == Approx(0.4));
  CHECK(degrees("vehicle: {kind: uav}\n") == Approx(0.4));
  CHECK(degrees("vehicle: {kind: handheld}\n") == 0.0);
  CHECK(degrees("vehicle: {kind: car}\nalignment: {settling_wander_deg_per_sqrt_s: 0}\n") == 0.0);
  CHECK(degrees("alignment: {settling_wander_deg_per_sqrt_s: 1}\n") == Approx(1.0));
  const auto confirming = [](const std::string& text) {
    return load_config_text(text, "x").navigator.alignment.confirming_s;
  };
  CHECK(confirming("vehicle: {kind: rail}\n") == 3.0);
  CHECK(confirming("vehicle: {kind: handheld}\n") == 0.0);
  CHECK(confirming("alignment: {confirming_s: 5}\n") == 5.0);
}

TEST_CASE("an odometer is for wheels, at the point that does not slide, unless said otherwise") {
  const auto motion_of = [](const std::string& vehicle) {
    return load_config_text("vehicle: {" + vehicle + "}\n", "x")
        .navigator.vehicle.motion.constraints;
  };
  CHECK(motion_of("kind: car").odometer);
  CHECK(motion_of("kind: rail").odometer);
  CHECK_FALSE(motion_of("kind: handheld").odometer);
  CHECK_FALSE(motion_of("kind: car, odometer: false").odometer);
  CHECK(motion_of("kind: boat, odometer: true").odometer);
  const auto at = motion_of("kind: car, constraint_point_b_m: [-1, 0, 0.5]");
  CHECK(at.odometer_point_b == at.point_b);
  CHECK(motion_of("constraint_point_b_m: [-1, 0, 0], odometer_point_b_m: [2, 0, 0]")
            .odometer_point_b.x() == 2.0);
  const auto ekf = load_config_text("vehicle: {kind: car, odometer_scale_sigma_percent: 2}\n", "x")
                       .navigator.ekf.vehicle;
  CHECK(ekf.count == 2);  // it joins with its first message
  CHECK(ekf.sigma[leonav::ekf_index::kOdometerScale] == Approx(0.02));
}
