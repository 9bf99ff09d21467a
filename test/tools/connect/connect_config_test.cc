// The configuration of leonav-connect: what is read, and what a mistake is told as.
#include "tools/connect/connect_config.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <variant>

#include "daemon/config/load_config.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

ConnectConfig load(const std::string& text) {
  const test::TemporaryFile file("connect.yaml", text);
  return load_connect_config(file.path(), {});
}

// The blocks of YAML in a page.
std::vector<std::string> yaml_blocks(const std::filesystem::path& page) {
  std::ifstream file(page);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string begin = "```yaml\n";
  std::vector<std::string> blocks;
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    blocks.push_back(text.substr(at, text.find("```", at) - at));
  }
  return blocks;
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

TEST_CASE("Every block of YAML in the pages of receivers and streams is a whole file",
          "[connect]") {
  const std::filesystem::path folder = LEONAV_SOURCE_DIR "/docs/operations";
  std::vector<std::filesystem::path> pages = {folder / "connect.md"};
  for (const auto& one : std::filesystem::directory_iterator(folder / "receivers")) {
    pages.push_back(one.path());
    const bool has_yaml = one.path().filename() == "README.md" || !yaml_blocks(one.path()).empty();
    CAPTURE(one.path().string());
    CHECK(has_yaml);
  }
  for (const auto& page : pages) {
    for (const std::string& block : yaml_blocks(page)) {
      const test::TemporaryFile file("connect.yaml", block);
      const std::string credentials = file.beside("caster.credentials");
      std::ofstream(credentials) << "user\npassword\n";
      REQUIRE(chmod(credentials.c_str(), 0600) == 0);
      CAPTURE(page.string(), block);
      CHECK_NOTHROW(load_connect_config(file.path(), {}));
    }
  }
}

TEST_CASE("Systems of which no ephemeris is missed are left out of a list, or all of them",
          "[connect]") {
  const std::string one = stream("name: a, source: stdin, format: ubx");
  CHECK(load(one).expected_orbits == ExpectedOrbits{true, true, true, false});
  const auto expected = [&](const std::string& list) {
    return load("warn_without_ephemerides: " + list + "\n" + one).expected_orbits;
  };
  CHECK(expected("[beidou, gps]") == ExpectedOrbits{true, false, true, false});
  CHECK(expected("[]") == ExpectedOrbits{});
  for (const char* wrong : {"[leo]", "[glonass]", "gps"}) {
    CHECK_THROWS_WITH(expected(wrong), Catch::Contains("warn_without_ephemerides"));
  }
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

TEST_CASE("Streams that are all files are told from those of which one is live", "[connect]") {
  const std::string file = stream("name: a, source: file, path: a.ubx, format: ubx");
  CHECK(has_only_files(load(file)));
  CHECK_FALSE(has_only_files(load(file + "  - {name: b, source: stdin, format: xsens}\n")));
}

TEST_CASE("A recording has a limit unless 0 takes it away", "[connect]") {
  const auto limit = [](const std::string& more) {
    return load(stream("name: a, source: stdin, format: ubx, record: a.leoraw" + more))
        .streams.at(0)
        .record_limit_bytes;
  };
  CHECK(limit("") == 10'000'000'000);
  CHECK(limit(", record_limit_mb: 500") == 500'000'000);
  CHECK(limit(", record_limit_mb: 0") == 0);
  CHECK_THROWS_AS(limit(", record_limit_mb: -1"), ConfigError);
}

TEST_CASE("Pages come from a service as text, or from a receiver that is told to use them",
          "[connect]") {
  const ConnectConfig config = load(
      "streams:\n  - {name: a, source: tcp, host: h, port: 1, format: ubx, corrections: true}\n"
      "  - {name: b, source: file, path: a.has, format: has}\n"
      "  - {name: c, source: stdin, format: b2b}\n");
  CHECK(config.streams.at(0).uses_pages);
  CHECK_FALSE(config.streams.at(0).is_service);
  CHECK(config.streams.at(1).format == FormatKind::kHas);
  CHECK(config.streams.at(1).is_service);
  CHECK(config.streams.at(2).format == FormatKind::kB2b);
  CHECK(std::string(name_of(FormatKind::kHas)) == "has");
  const std::string septentrio = "name: a, source: tcp, host: h, port: 1, format: sbf";
  CHECK_FALSE(load(stream(septentrio)).streams.at(0).uses_pages);
  CHECK(load(stream(septentrio + ", corrections: true")).streams.at(0).uses_pages);
  CHECK_THROWS_AS(load(stream("name: b, source: stdin, format: has, latency_ms: 3")), ConfigError);
  CHECK_THROWS_AS(load(stream("name: b, source: stdin, format: vectornav, corrections: true")),
                  ConfigError);
}

TEST_CASE("The times after which another correction service is used are bounded", "[connect]") {
  const std::string receiver = stream("name: a, source: tcp, host: h, port: 1, format: sbf");
  CHECK(load(receiver).services.fallback_s == 30.0);
  CHECK(load(receiver).services.return_s == 60.0);
  const ConnectConfig config = load("corrections: {fallback_s: 12, return_s: 0}\n" + receiver);
  CHECK(config.services.fallback_s == 12.0);
  CHECK(config.services.return_s == 0.0);
  CHECK_THROWS_AS(load("corrections: {fallback_s: 1}\n" + receiver), ConfigError);
}

TEST_CASE("A NovAtel stream is a receiver, and an inertial sensor where that is asked for",
          "[connect]") {
  const std::string receiver = "name: span, source: tcp, host: span, port: 3001, format: oem7";
  const StreamConfig plain = load(stream(receiver)).streams.at(0);
  CHECK(plain.format == FormatKind::kOem7);
  CHECK_FALSE(plain.is_inertial);
  CHECK_FALSE(plain.imu_scale);
  const StreamConfig span =
      load(stream(receiver + ", inertial: true, imu_scale: [1e-9, 2e-8]")).streams.at(0);
  CHECK(span.is_inertial);
  CHECK(span.imu_scale->angle_rad == 1e-9);
  CHECK(span.imu_scale->velocity_m_s == 2e-8);
  for (const char* scale : {"[1e-9]", "[1e-9, 0]", "[1e-9, -1e-9]", "[1, 2]", "[a, b]", "7"}) {
    CHECK_THROWS_AS(load(stream(receiver + ", imu_scale: " + scale)), ConfigError);
  }
  const std::string other = "  - {name: imu, source: stdin, format: vectornav}\n";
  CHECK(load(stream(receiver) + other).streams.size() == 2);
  CHECK_THROWS_AS(load(stream(receiver + ", inertial: true") + other), ConfigError);
}

TEST_CASE("A Septentrio stream is a receiver, and an inertial sensor where that is asked for",
          "[connect]") {
  const std::string receiver = "name: x5, source: tcp, host: x5, port: 28785, format: sbf";
  const StreamConfig plain = load(stream(receiver)).streams.at(0);
  CHECK(plain.format == FormatKind::kSbf);
  CHECK(std::string(name_of(plain.format)) == "sbf");
  CHECK_FALSE(plain.is_inertial);
  CHECK(load(stream(receiver + ", inertial: true")).streams.at(0).is_inertial);
  CHECK(load(stream(receiver + ", repeat_ephemerides_s: 5")).streams.at(0).repeat_s == 5.0);
  CHECK_THROWS_AS(load(stream(receiver + ", latency_ms: 5")), ConfigError);
  CHECK_THROWS_AS(load(stream(receiver + ", imu_scale: [1e-9, 2e-8]")), ConfigError);
  const std::string other = "  - {name: imu, source: stdin, format: vectornav}\n";
  CHECK(load(stream(receiver) + other).streams.size() == 2);
  CHECK_THROWS_AS(load(stream(receiver + ", inertial: true") + other), ConfigError);
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

TEST_CASE("A stream of a caster, of a client and of datagrams is described", "[connect]") {
  const test::TemporaryFile credentials("caster", "me\nsecret-word\n");
  chmod(credentials.path().c_str(), 0600);
  const std::string caster =
      "name: base, source: ntrip, host: caster, mountpoint: BASE, format: "
      "rtcm3, credentials_file: " +
      credentials.path();
  const ConnectConfig config =
      load(stream(caster + ", version: 2, tls: true, position: [52.5, 13.4, 80], "
                           "position_interval_s: 5"));
  const auto& ntrip = std::get<NtripOptions>(config.streams.at(0).source);
  CHECK(ntrip.port == 2101);
  CHECK(ntrip.version == NtripVersion::k2);
  CHECK(ntrip.tls);
  CHECK(ntrip.position_line().starts_with("$GPGGA,"));
  CHECK(ntrip.position_interval_s == 5.0);
  CHECK(text_of(config.streams.at(0).source) == "NTRIP caster:2101/BASE over TLS");
  CHECK_FALSE(std::get<NtripOptions>(load(stream(caster)).streams.at(0).source).position_line);
  const auto problem = [&](const std::string& keys) -> std::string {
    try {
      load(stream(keys));
      return "none";
    } catch (const ConfigError& error) {
      CHECK_THAT(error.what(), !Catch::Contains("secret-word"));
      return error.what();
    }
  };
  CHECK_THAT(problem(caster + ", position: [91, 0, 0]"), Catch::Contains("latitude"));
  CHECK_THAT(problem(caster + ", position: [1, 2]"), Catch::Contains("latitude"));
  CHECK_THAT(problem(caster + ", ca_file: a.pem"), Catch::Contains("ca_file"));
  CHECK_THAT(
      problem(caster + ", tls: true, ca_file: none.pem"),
      Catch::Contains("PEM") && Catch::Contains("ca_file") && !Catch::Contains("credentials_file"));
  CHECK_THAT(problem("name: a, source: ntrip, host: b, mountpoint: \"B C\", format: rtcm3"),
             Catch::Contains("mountpoint"));
  CHECK_THAT(problem("name: a, source: ntrip, host: \"b\\r\\nX: y\", mountpoint: B, format: rtcm3"),
             Catch::Contains("host"));
  // As others write it; the message must not quote what may be a password.
  for (const char* host : {"joe:secret-word@caster.example", "http://caster.example/secret-word",
                           "caster.example:2101:secret-word", "joe@secret-word"}) {
    const std::string written = std::string(", host: \"") + host + "\", ";
    CHECK_THAT(problem("name: a, source: ntrip" + written + "mountpoint: B, format: rtcm3"),
               Catch::Contains("host") && Catch::Contains("credentials_file"));
    CHECK_THAT(problem("name: a, source: tcp" + written + "port: 1, format: rtcm3"),
               Catch::Contains("host") && Catch::Contains("'port'"));
  }
  for (const char* host : {"::1", "fe80::1%lo", "192.168.1.10", "caster_1.example"}) {
    const std::string written = std::string(", host: \"") + host + "\", ";
    CHECK(problem("name: a, source: tcp" + written + "port: 1, format: rtcm3") == "none");
  }
  chmod(credentials.path().c_str(), 0644);
  CHECK_THAT(problem(caster), Catch::Contains("chmod 600"));

  const std::string service = "name: a, source: udp, port: 1, format: rtcm3, corrections: true";
  CHECK(load(stream(service)).streams.at(0).silent_s == 15.0);
  CHECK(load(stream(service + ", silent_s: 4")).streams.at(0).silent_s == 4.0);

  const ConnectConfig server = load(stream("name: a, source: tcp_server, port: 5000, format: ubx"));
  CHECK(text_of(server.streams.at(0).source) == "a client at 127.0.0.1:5000");
  const ConnectConfig udp =
      load(stream("name: a, source: udp, address: 0.0.0.0, port: 5000, format: ubx"));
  CHECK(text_of(udp.streams.at(0).source) == "UDP at 0.0.0.0:5000");
  CHECK_THAT(problem("name: a, source: udp, format: ubx"), Catch::Contains("port"));
  CHECK_THAT(problem("name: a, source: udp, address: here, port: 5000, format: ubx"),
             Catch::Contains("address"));
}

TEST_CASE("A receiver of RTCM 3 and an inertial sensor have room beside each other", "[connect]") {
  const std::string base = "name: base, source: tcp, host: b, port: 1, format: rtcm3";
  const std::string imu = "name: imu, source: serial, device: /dev/x, format: vectornav";
  CHECK(load(stream(base) + "  - {" + imu + "}\n").streams.size() == 2);
  CHECK_THROWS_WITH(load(stream(base) + "  - {name: a, source: stdin, format: ubx}\n"),
                    Catch::Contains("two receivers"));
}

TEST_CASE("A receiver with an inertial sensor is both, and pulses need who sends and who sees them",
          "[connect]") {
  const std::string receiver = "name: r, source: serial, device: /dev/x, format: ubx";
  const std::string imu = "  - {name: imu, source: serial, device: /dev/y, format: xsens}\n";
  CHECK_FALSE(load(stream(receiver)).streams.at(0).is_inertial);
  const StreamConfig own =
      load(stream(receiver + ", inertial: true, latency_ms: 10")).streams.at(0);
  CHECK(own.is_inertial);
  CHECK(own.stamps.latency_s == Approx(0.01));
  CHECK_THROWS_AS(load(stream(receiver + ", latency_ms: 10")), ConfigError);
  CHECK(load(stream(receiver) + imu).streams.at(1).format == FormatKind::kXsens);
  CHECK_THROWS_WITH(load(stream(receiver + ", inertial: true") + imu),
                    Catch::Contains("two inertial sensors"));

  const auto with = [&](const std::string& pulse, const std::string& streams) {
    return load("time: {pulse: {" + pulse + "}}\n" + streams);
  };
  const PulseConfig pulse =
      with("stream: imu, input: 1, edge: falling, delay_ms: -2", stream(receiver) + imu).pulse;
  CHECK(pulse.stream == "imu");
  CHECK(pulse.input.input == 1);
  CHECK(pulse.input.is_falling);
  CHECK(pulse.input.delay_s == Approx(-0.002));
  CHECK_THROWS_WITH(with("stream: imu", stream(receiver)),
                    Catch::Contains("no stream of an inertial sensor has this name"));
  CHECK_THROWS_WITH(with("stream: r", stream(receiver + ", inertial: true")),
                    Catch::Contains("no stream of an inertial sensor has this name"));
  CHECK_THROWS_WITH(with("stream: imu", "streams:\n" + imu), Catch::Contains("format ubx"));
  CHECK_THROWS_AS(with("stream: imu, input: 2", stream(receiver) + imu), ConfigError);
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
  // What a stream with an error is meant to be is not judged.
  CHECK_THAT(problem(stream(serial + ", format: ubx") +
                     "  - {name: b, source: ntrip, host: c, mountpoint: m, format: rtcm3, "
                     "corrections: true, credentials_file: /nowhere/to/be/found}\n"),
             Catch::Contains("credentials_file") && !Catch::Contains("two receivers"));
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

TEST_CASE("All mistakes of all streams are told at once, and nothing that follows from one",
          "[connect]") {
  std::string problem;
  try {
    load(
        "lcm: {url: ''}\nstreams:\n"
        "  - {name: a, source: ntrip, host: x@y, position: [91, 0, 0], position_interval_s: 0.5,\n"
        "     format: rtcm3, silent_s: 0}\n"
        "  - {source: serial, format: imu_line, buad: 1,\n"
        "     line: {columns: [clock, gyro], axes: [x, v, w], prefx: A}}\n"
        "  - {name: a, source: stdin, format: ubx}\n");
  } catch (const ConfigError& error) {
    problem = error.what();
  }
  for (const char* wrong :
       {"1: lcm.url: must not be empty", "3: streams[0].host: must be a name",
        "3: streams[0].mountpoint: must name a stream", "3: streams[0].position: must be [lat",
        "3: streams[0].position_interval_s: must be at least 1 s", "4: streams[0].silent_s: 0 is",
        "5: streams[1].name: must be given", "5: streams[1].device: must name a port",
        "6: streams[1].line.columns: 'clock' is no column",
        "6: streams[1].line.columns: 'gyro' is no column",
        "6: streams[1].line.axes: 'v' is no axis", "6: streams[1].line.axes: 'w' is no axis",
        "6: streams[1].line.prefx: unknown key", "5: streams[1].buad: unknown key",
        "3: streams: two are named 'a'"}) {
    CHECK_THAT(problem, Catch::Contains(std::string("connect.yaml:") + wrong));
  }
  CHECK(std::count(problem.begin(), problem.end(), '\n') == 14);
}

}  // namespace leonav
