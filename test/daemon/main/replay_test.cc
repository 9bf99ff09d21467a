// leonav-replay does not pass for a success where the log gives no answer.
#include <filesystem>
#include <string>

#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/has.h"
#include "support/programs/program_run.h"

namespace {

using namespace leonav;
using test::has;

// 30 s of a drive without one of its channels, begun by a configuration if there is one.
void write_log_without(Channel channel, const std::string& path,
                       const std::string& configuration = "") {
  EventLogWriter log(path);
  if (!configuration.empty()) {
    REQUIRE(log.write(1, channel_name(Channel::kConfig),
                      encode(RunConfiguration{"leonavd", "a.yaml", configuration, {}})));
  }
  test::feed_messages(test::synthetic_drive(test::noisy_drive(30.0)),
                      [&](Channel one, ByteSpan bytes) {
                        if (one != channel) REQUIRE(log.write(1, channel_name(one), bytes));
                      });
  REQUIRE(log.flush());
}

struct Replay {
  test::ProgramRun run;
  std::string summary;
};

Replay replay_without(Channel channel, const std::string& options = "") {
  const test::TemporaryFile folder("unused", "");
  write_log_without(channel, folder.beside("log"));
  Replay replay;
  replay.run = test::run_program("leonav-replay", "--preset phone_imu " + options + " --out '" +
                                                      folder.beside("out") + "' '" +
                                                      folder.beside("log") + "'");
  replay.summary = test::text_of(folder.beside("out/summary.txt"));
  return replay;
}

}  // namespace

TEST_CASE("an inertial configuration on a log without IMU fails and names the remedy") {
  if (!test::have_programs("leonav-replay")) return;
  const Replay replay = replay_without(Channel::kImu);
  CHECK(replay.run.exit_code == 1);
  for (const std::string& text : {replay.run.err, replay.summary}) {
    CHECK(has(text, "ekf.motion is inertial, but the log has no IMU"));
    CHECK(has(text, "use --set ekf.motion=constant_velocity"));
  }
  const Replay mended = replay_without(Channel::kImu, "--set ekf.motion=constant_velocity");
  CHECK(mended.run.exit_code == 0);
  CHECK(has(mended.summary, "solutions by source ekf: 29"));
}

TEST_CASE("a log without GNSS epochs, or without ephemerides, fails") {
  if (!test::have_programs("leonav-replay")) return;
  for (const std::string options : {"", "--set ekf.motion=constant_velocity"}) {
    INFO(options);
    const Replay no_epochs = replay_without(Channel::kGnssEpoch, options);
    CHECK(no_epochs.run.exit_code == 1);
    CHECK(has(no_epochs.run.err, "no position without GNSS: the log has no GNSS_EPOCH"));
    CHECK(has(no_epochs.summary, "failure: no position without GNSS"));
    const Replay no_ephemerides = replay_without(Channel::kEphemeris, options);
    CHECK(no_ephemerides.run.exit_code == 1);
    CHECK(has(no_ephemerides.run.err, "no position was found"));
  }
}

TEST_CASE("the summary of a log that is cut short says so, and that it is no journal") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string log = folder.beside("log");
  write_log_without(Channel::kCommand, log);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 5);
  const std::string arguments =
      "--preset phone_imu --out '" + folder.beside("out") + "' '" + log + "'";
  const auto run = test::run_program("leonav-replay", arguments);
  CHECK(run.exit_code == 0);
  CHECK(has(run.err, "its last message is cut short"));
  CHECK(has(test::text_of(folder.beside("out/summary.txt")), "its last message is cut short"));

  const auto verify = test::run_program("leonav-replay", "--verify " + arguments);
  CHECK(verify.exit_code == 1);
  CHECK(has(verify.err, "the log is no journal of leonavd"));
  const std::string summary = test::text_of(folder.beside("out/summary.txt"));
  CHECK(has(summary, "failure: nothing to verify: the log is no journal"));
  CHECK_FALSE(has(summary, "the journal was cut"));
}

TEST_CASE("--set acts on a journal's configuration as on a file; a preset beneath it is refused") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string log = folder.beside("log");
  write_log_without(Channel::kCommand, log, effective_text(load_preset("phone_imu").source));
  const auto replay = [&](const std::string& options) {
    return test::run_program("leonav-replay",
                             options + " --out '" + folder.beside("out") + "' '" + log + "'");
  };
  CHECK(replay("--preset phone_imu").exit_code == 0);
  CHECK_FALSE(std::filesystem::exists(folder.beside("out/constraints.csv")));
  const auto car = replay("--set vehicle.kind=car --set 'vehicle.lever_arm_b_m=[0, 0, -1]'");
  INFO(car.out << car.err);
  CHECK(car.exit_code == 0);
  CHECK(std::filesystem::exists(folder.beside("out/constraints.csv")));
  // The way back, for a shell; what follows from the kind is not listed.
  CHECK(has(car.out, "the journal was written with --set 'vehicle.lever_arm_b_m=["));
  CHECK(has(car.out, "]' --set vehicle.kind=handheld"));
  CHECK_FALSE(has(car.out, "non_holonomic"));
  // The configuration that it ran with is beside the tables, and loads as the same.
  const std::string told = test::text_of(folder.beside("out/configuration.yaml"));
  CHECK(has(told, "kind: car"));
  CHECK(has(told, "risk_per_hour: 1e-05"));
  CHECK_NOTHROW(load_config_text(told, "told", {}));
  const auto preset = replay("--set preset=car");
  CHECK(preset.exit_code == 2);
  CHECK(has(preset.err, "--set preset=car: a preset is beneath"));
  CHECK(has(preset.err, "--preset NAME replaces that configuration"));
}

TEST_CASE("leonav-replay --help states its exit codes") {
  if (!test::have_programs("leonav-replay")) return;
  const auto help = test::run_program("leonav-replay", "--help");
  CHECK(help.exit_code == 0);
  CHECK(has(help.out, "Exit codes: 0 done; 1 "));
}
