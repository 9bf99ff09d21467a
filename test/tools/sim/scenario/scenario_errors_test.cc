// The mistakes of a scenario are told at once.
#include <algorithm>
#include <string>

#include "daemon/config/load_config.h"
#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"

namespace leonav::sim {

TEST_CASE("all mistakes of a scenario are told at once, those within a group too", "[sim]") {
  std::string problem;
  try {
    load_scenario_text(
        "seed: 1.5\nstart_gps_week: 2.5\nduration: 5\n"
        "route: {waypoints: [{north_m: 1}], file: none.csv, hil_m: 1}\n"
        "imu: {vibration: {low_hz: 5, high_hz: 5, accel_idle_m_s2: 1, hz: 1}, rate_hz: 10}\n"
        "odometer: {rate_hz: 0.5, signd: true}\n"
        "satellites: {leo: {file: x, shells: [{planes: 0}, {eccentricity: 9}], signals: [9S, 9S],"
        " x: 1}}\n"
        "receiver: {tracking: {hold_dbhz: 50, acquire_dbhz: 40, carier_s: 1}}\n"
        "street_errors: {multipath: {code_low_m: [2, 1], carrier_low_m: [1], time: 1}}\n"
        "faults: [{kind: outage, from_s: 5, to_s: 1, systems: [x], satellites: [y], z: 1}, "
        "{from_s: 1, q: "
        "1}]\n",
        "s.yaml");
  } catch (const ConfigError& error) {
    problem = error.what();
  }
  for (const char* wrong :
       {"1: seed: must be a whole number", "2: start_gps_week: must be", "3: duration: unknown key",
        "4: route.waypoints: one alone", "4: route.file: and waypoints", "4: route.hil_m: unknown",
        "5: imu.vibration.high_hz: must be greater", "5: imu.vibration.high_hz: must be below",
        "5: imu.vibration.hz: unknown key", "6: odometer.rate_hz: must be 0",
        "6: odometer.signd: unknown", "7: satellites.leo.file: is for GPS",
        "7: satellites.leo.shells[0].planes: 0 is out", "7: satellites.leo.shells[1].eccentricity",
        "7: satellites.leo.shells[0].semi_major_axis_km: must be given",
        "7: satellites.leo.shells[1].semi_major_axis_km: must be given",
        "7: satellites.leo.signals: must be two", "7: satellites.leo.x: unknown key",
        "8: receiver.tracking.hold_dbhz: must not be above", "8: receiver.tracking.carier_s: unkn",
        "9: street_errors.multipath.code_low_m: must be",
        "9: street_errors.multipath.carrier_low_m", "9: street_errors.multipath.time: unknown key",
        "10: faults[0].to_s: must be after", "10: faults[0].systems: 'x' is none",
        "10: faults[0].satellites: 'y' is no", "10: faults[0].z: unknown key",
        // Which keys a fault has depends on its kind: the rest is not judged without one.
        "10: faults[1].kind: must be given"}) {
    CHECK_THAT(problem, Catch::Contains(std::string("s.yaml:") + wrong));
  }
  CHECK(std::count(problem.begin(), problem.end(), '\n') == 27);
}

}  // namespace leonav::sim
