// Mistakes of a first run through the programs as a user runs them; tools/validate
// first-run-mistakes has them all.
#include "edited_log.h"
#include "recorded_runs.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using namespace leonav::test;

// A drive of a minute and a half, off after ten seconds; the antenna ahead of the IMU.
std::string simulated(const TemporaryFile& place) {
  const std::string log = place.beside("simulated.lcmlog");
  const ProgramRun run =
      run_program("leonav-sim", "'" LEONAV_SOURCE_DIR "/config/scenario/urban.yaml' -o '" + log +
                                    "' --set duration_s=90 --set route.standing_s=10"
                                    " --set 'receiver.lever_arm_b_m=[1.5, 0.4, -1.2]'");
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return log;
}

// Writes `log` anew with each IMU sample changed.
template <typename Change>
std::string with_imu(const TemporaryFile& place, const std::string& log, Change change) {
  const std::string path = place.beside("mistaken.lcmlog");
  EventLogReader reader(log);
  EventLogWriter writer(path);
  Decoder decoder;
  Encoder encoder;
  ImuSample sample;
  LogEvent event;
  while (reader.next(&event)) {
    ByteSpan bytes(event.data);
    if (event.channel == channel_name(Channel::kImu)) {
      const DecodeResult result = decoder.decode(bytes, &sample);
      REQUIRE(result.fault == InputFault::kNone);
      change(&sample);
      bytes = encoder.encode(sample, result.sequence);
    }
    REQUIRE(writer.write(event.timestamp_us, event.channel, bytes));
  }
  REQUIRE(writer.flush());
  return path;
}

// What leonav-replay warns of.
std::string warned(const TemporaryFile& place, const std::string& log,
                   const std::string& arm = "[1.5, 0.4, -1.2]") {
  const ProgramRun run =
      run_program("leonav-replay", config("urban") + " --set 'vehicle.lever_arm_b_m=" + arm +
                                       "' --out " + place.beside("result") + " " + log);
  CAPTURE(run.err);
  const std::size_t at = run.err.find("convention_suspect");
  // With some mistakes there is no position: an error too, but told of. No other is expected.
  if (run.exit_code != 0) {
    CHECK(run.exit_code == 1);
    CHECK(at != std::string::npos);
    CHECK(run.err.find("no position was found") != std::string::npos);
  }
  return at == std::string::npos ? "" : run.err.substr(at);
}

bool tells(const std::string& warning, const std::string& name, const std::string& remedy) {
  CAPTURE(warning);
  CHECK(warning.find("convention_suspect " + name + " ") == 0);
  CHECK(warning.find(remedy) != std::string::npos);
  return true;
}

TEST_CASE("mistakes of a first run are reported with their remedies, a correct run has no report") {
  if (!have_programs("leonav-sim", "leonav-replay")) return;
  const TemporaryFile place("conventions", "");
  const std::string log = simulated(place);
  CHECK(warned(place, log).empty());

  const auto imu = [&](auto change) { return warned(place, with_imu(place, log, change)); };
  const std::string up = imu([](ImuSample* sample) {
    sample->delta_theta_b.tail<2>() *= -1.0;
    sample->delta_velocity_b.tail<2>() *= -1.0;
  });
  tells(up, "forward_left_up", "vehicle.mounting_rpy_deg: [180, 0, 0]");
  const std::string degrees =
      imu([](ImuSample* sample) { sample->delta_theta_b *= 180.0 / EIGEN_PI; });
  tells(degrees, "gyros_in_degrees", "multiply by pi/180");
  const std::string rates = imu([](ImuSample* sample) {
    sample->delta_theta_b /= sample->interval_s();
    sample->delta_velocity_b /= sample->interval_s();
  });
  tells(rates, "rates_as_increments", "by the interval");
  const std::string utc =
      imu([](ImuSample* sample) { sample->time = sample->time.plus_seconds(-18.0); });
  tells(utc, "leap_seconds", "the IMU is in UTC), stamp it in GPS time");

  const std::string doppler = edited(place, log, [](int, RawEpoch* epoch) {
    for (SignalObservation& observation : epoch->observations) observation.doppler_hz *= -1.0;
    return true;
  });
  tells(warned(place, doppler), "doppler_sign", "positive while the satellite comes nearer");
  tells(warned(place, log, "[-1.5, -0.4, -1.2]"), "lever_arm_sign", "from the IMU to the antenna");
}

TEST_CASE("recorded and semi-real runs are not accused of anything") {
  if (!have_shared_data("walk/dataset.yaml") || !have_shared_data("drive/truth.csv")) return;
  if (!have_programs("leonav-import", "leonav-imu-from-truth", "leonav-replay")) return;
  const auto quiet = [](const TemporaryFile& place, const std::string& log,
                        const std::string& configuration) {
    const ProgramRun run = run_program(
        "leonav-replay", config(configuration) + " --out " + place.beside("r") + " " + log);
    CAPTURE(run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("convention_suspect") == std::string::npos);
  };
  const TemporaryFile walk("walk", ""), drive("drive", "");
  quiet(walk, imported(walk, "walk"), "walk");
  quiet(drive, semi_real_log(drive, drive.beside("truth.csv")), "phone_imu");
}

}  // namespace
