// The configuration of leonav-connect: what is read, and what a mistake is told as.
#include "tools/connect/connect_config.h"

#include "daemon/config/load_config.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

ConnectConfig load(const std::string& text) {
  const test::TemporaryFile file("connect.yaml", text);
  return load_connect_config(file.path(), {});
}

std::string stream(const std::string& keys) { return "streams:\n  - {" + keys + "}\n"; }

}  // namespace

TEST_CASE("The example configuration is good, and says what it seems to say", "[connect]") {
  const ConnectConfig config =
      load_connect_config(LEONAV_SOURCE_DIR "/config/connect.yaml", {"lcm.prefix=CAR_"});
  CHECK(config.lcm.prefix == "CAR_");
  REQUIRE(config.streams.size() == 2);
  CHECK(config.streams[0].format == FormatKind::kUbx);
  CHECK(text_of(config.streams[0].source) == "/dev/ttyACM0 at 460800 baud");
  CHECK(config.streams[1].format == FormatKind::kVectornav);
}

TEST_CASE("RTCM 3 from a file needs the day of its recording", "[connect]") {
  const ConnectConfig config =
      load(stream("name: base, source: file, path: a.rtcm3, format: rtcm3, date: 2024-03-20"));
  CHECK(config.streams.at(0).format == FormatKind::kRtcm3);
  CHECK(config.streams.at(0).day.is_set());
  CHECK_FALSE(load(stream("name: base, source: tcp, host: caster, port: 2101, format: rtcm3"))
                  .streams.at(0)
                  .day.is_set());
  CHECK_THROWS_AS(load(stream("name: base, source: file, path: a.rtcm3, format: rtcm3")),
                  ConfigError);
  CHECK_THROWS_AS(
      load(stream("name: base, source: file, path: a.rtcm3, format: rtcm3, date: 2024-02-30")),
      ConfigError);
}

TEST_CASE("A sensor that writes text is described by columns, units and axes", "[connect]") {
  const ConnectConfig config = load(
      stream("name: imu, source: tcp, host: sensor, port: 4001, format: imu_line, latency_ms: 2,"
             " line: {columns: [clock_us, gyro_x, gyro_y, gyro_z, accel_x, accel_y, accel_z],"
             " separator: semicolon, gyro_unit: deg/s, accel_unit: g, accel_scale: 0.5,"
             " axes: [y, x, -z]}"));
  const StreamConfig& imu = config.streams.at(0);
  CHECK(text_of(imu.source) == "sensor:4001");
  CHECK(imu.line.separator == ';');
  CHECK(imu.line.accel_unit == Approx(0.5 * 9.80665));
  CHECK(imu.line.axes == std::array{2, 1, -3});
  CHECK(imu.stamps.latency_s == 0.002);
}

TEST_CASE("A mistake is told with its line and the remedy", "[connect]") {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      load(text);
      return "none";
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  const std::string serial = "name: a, source: serial, device: /dev/x";
  CHECK_THAT(problem("lcm: {prefix: A_}\n"), Catch::Contains("at least one stream"));
  CHECK_THAT(problem(stream("source: stdin, format: ubx")), Catch::Contains("name"));
  CHECK_THAT(problem(stream(serial + ", format: ubk")), Catch::Contains("ubk"));
  CHECK_THAT(problem(stream(serial + ", format: ubx, buad: 9600")), Catch::Contains("baud"));
  CHECK_THAT(problem(stream("name: a, source: tcp, host: b, format: ubx")),
             Catch::Contains("port"));
  CHECK_THAT(problem(stream("name: a, source: tcp, host: b, port: 1, baud: 9600, format: ubx")),
             Catch::Contains("unknown key") && Catch::Contains("connect.yaml:2"));
  CHECK_THAT(
      problem(stream(serial + ", format: ubx") + "  - {" + serial + ", format: vectornav}\n"),
      Catch::Contains("two are named 'a'"));
  CHECK_THAT(
      problem(stream(serial + ", format: ubx") + "  - {name: b, source: stdin, format: ubx}\n"),
      Catch::Contains("two receivers"));
  const std::string columns = "gyro_x, gyro_y, gyro_z, accel_x, accel_y, accel_z";
  const auto lines = [&](const std::string& line, const std::string& more = "") {
    return problem(stream(serial + ", format: imu_line, line: {" + line + "}" + more));
  };
  CHECK_THAT(lines("columns: [" + columns + "]"), Catch::Contains("rate_hz"));
  CHECK(lines("columns: [" + columns + "]", ", rate_hz: 100") == "none");
  CHECK_THAT(lines("columns: [clock_s, " + columns + "], axes: [x, y, -z]"),
             Catch::Contains("mirrored"));
  CHECK_THAT(lines("columns: [clock, " + columns + "]"), Catch::Contains("'clock' is no column"));
}

}  // namespace leonav
