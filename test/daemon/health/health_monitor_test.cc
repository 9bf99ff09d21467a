// What HEALTH says when an input falls silent, whatever came before it.
#include "daemon/health/health_monitor.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <leonav/health_t.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "discard.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Discard;

// An engine and its health, fed in step.
class Watched {
 public:
  explicit Watched(MotionModel motion, bool odometer = false, const IntegrityConfig& integrity = {},
                   const std::string& journal = "", DiskHook hook = {},
                   double epoch_interval_s = 1.0) {
    DaemonConfig config = test::drive_config();
    config.journal.path = journal;
    config.navigator.integrity = integrity;
    config.navigator.vehicle.motion.constraints.odometer = odometer;
    config.navigator.motion = motion;
    config.navigator.realtime.epoch_interval_s = epoch_interval_s;
    EngineHooks hooks;
    hooks.disk_call = std::move(hook);
    engine_ = std::make_unique<Engine>(config, &target_, std::move(hooks));
    engine_->start();
    health_ = std::make_unique<HealthMonitor>(engine_.get(), config.navigator);
  }
  ~Watched() { CHECK(engine_->finish()); }

  template <typename Wanted>
  void feed(Wanted wanted) {
    static const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(60.0));
    test::feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
      if (wanted(channel)) receive(channel, bytes);
    });
  }

  void receive(Channel channel, ByteSpan bytes) {
    engine_->receive(channel, bytes, 1);
    while (!engine_->idle()) test::wait_a_moment();
  }

  // "status: why" at `now_s`.
  std::string at(double now_s) {
    const auto bytes = health_->next(now_s);
    REQUIRE(message_.decode(bytes.data(), 0, static_cast<int>(bytes.size())) ==
            static_cast<int>(bytes.size()));
    CHECK(message_.status == to_string(health_->status()));
    CHECK(message_.why == health_->why());
    return message_.status + ": " + message_.why;
  }

  const health_t& message() const { return message_; }  // of the last at()
  Fault fault() const { return health_->fault(); }
  Engine* engine() { return engine_.get(); }

 private:
  Discard target_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<HealthMonitor> health_;
  health_t message_{};
};

const std::string kNoImu = "no usable IMU (nothing comes): look at its sender";
const std::string kNoGnss = "no usable GNSS (nothing comes): look at its sender and the antenna";
const std::string kLate = "no solution of late: the reasons beside this one say why";
const std::string kEnded = "the solution has ended: the reasons beside this one say why";
const std::string kInsOnly = "INS only: wait for satellites (the sigma grows until then)";

const auto everything = [](Channel) { return true; };
const auto all_but_imu = [](Channel channel) { return channel != Channel::kImu; };

}  // namespace

TEST_CASE("HEALTH without any input says what is missing") {
  Watched with_imu(MotionModel::kInertial);
  const std::string nothing =
      "FAULT: no solution yet (no GNSS has come: look at its sender and lcm.url)";
  CHECK(with_imu.at(1.0) == nothing + "; " + kNoImu);
  CHECK(with_imu.at(100.0) == nothing + "; " + kNoImu + "; " + kNoGnss);
  Watched gnss_only(MotionModel::kConstantVelocity);
  CHECK(gnss_only.at(1.0) == nothing);
  CHECK(gnss_only.at(3.0) == nothing + "; " + kNoGnss);
}

TEST_CASE("GNSS alone that dies: degraded after 2.5 intervals, a fault after 10") {
  Watched watched(MotionModel::kConstantVelocity);
  watched.feed(all_but_imu);
  CHECK(watched.at(60.0) == "OK: ");
  CHECK(watched.at(62.4) == "OK: ");
  CHECK(watched.at(62.6) == "DEGRADED: " + kLate + "; " + kNoGnss);
  CHECK(watched.at(70.0) == "DEGRADED: " + kLate + "; " + kNoGnss);
  CHECK(watched.message().source == "ekf");
  CHECK(watched.fault() == Fault::kNone);
  CHECK(watched.at(71.0) == "FAULT: " + kEnded + "; " + kNoGnss);
  CHECK(watched.fault() == Fault::kSilence);
  CHECK(watched.message().source == "none");
  // Damaged messages are no sign of life, and are told.
  for (int i = 0; i < 20; ++i)
    watched.receive(Channel::kGnssEpoch, std::vector<std::uint8_t>(40, 0x55));
  CHECK(watched.at(72.0) ==
        "FAULT: " + kEnded +
            "; no usable GNSS (messages come, but are rejected as too_many): look at its sender "
            "and the antenna; a tenth or more of an input is rejected (GNSS_EPOCH as too_many): "
            "look at its sender and the events rejected_input");
  CHECK(watched.fault() == Fault::kNavigation);
}

TEST_CASE("an IMU that dies: degraded after a second, a fault when the answer is too old") {
  Watched watched(MotionModel::kInertial);
  watched.feed(everything);
  CHECK(watched.at(60.0) == "OK: ");
  for (double now_s = 60.1; now_s < 60.85; now_s += 0.1) CHECK(watched.at(now_s) == "OK: ");
  watched.at(60.9);
  CHECK(watched.at(61.0) == "DEGRADED: " + kNoImu);
  CHECK(watched.at(65.0) == "DEGRADED: " + kLate + "; " + kNoImu + "; " + kNoGnss);
  CHECK(watched.at(71.0) == "FAULT: " + kEnded + "; " + kNoImu + "; " + kNoGnss);
}

TEST_CASE("without its IMU an answer is late, and ended, by the interval of the epochs") {
  Watched watched(MotionModel::kInertial, false, {}, "", {}, 5.0);
  watched.feed(all_but_imu);
  const auto says = [&](const std::string& reason, double now_s) {
    return watched.at(now_s).find(reason) != std::string::npos;
  };
  CHECK(says("aligning (no IMU sample is used)", 60.0));
  CHECK_FALSE(says(kLate, 72.4));
  CHECK(says(kLate, 72.6));
  CHECK_FALSE(says(kEnded, 109.9));
  CHECK(watched.fault() == Fault::kNone);
  CHECK(says(kEnded, 110.1));
}

TEST_CASE("GNSS that dies beside an IMU is reported by its own name; the answer goes on degraded") {
  Watched watched(MotionModel::kInertial);
  int epochs = 0, samples = 0;
  std::string at_30_s, at_34_s, at_59_s;
  watched.feed([&](Channel channel) {
    if (channel == Channel::kGnssEpoch) return ++epochs <= 30;
    if (channel == Channel::kImu && ++samples % 200 == 0) {  // once a second
      const double now_s = samples / 200;
      const std::string said = watched.at(now_s);
      if (now_s == 30.0) at_30_s = said;
      if (now_s == 34.0) at_34_s = said;
      if (now_s == 59.0) at_59_s = said;
    }
    return true;
  });
  // The epoch of the 30th second comes a latency after it, so it is the next look that sees it.
  CHECK(at_30_s == "OK: ");
  CHECK(at_34_s.find("DEGRADED: " + kInsOnly + "; no usable GNSS") == 0);
  CHECK(at_59_s == "DEGRADED: " + kInsOnly + "; " + kNoGnss);
  CHECK(watched.message().source == "ins");
}

TEST_CASE("an odometer that falls silent is reported, one that never sent is not missed") {
  Watched watched(MotionModel::kInertial, true);
  CHECK(watched.at(1.0).find("odometer") == std::string::npos);
  CHECK(std::isnan(watched.message().odometer_age_s));
  Encoder encoder;
  std::uint64_t samples = 0, increments = 0;
  watched.feed([&](Channel channel) {
    if (channel != Channel::kImu || ++samples > 6000 || samples % 20 != 0) return true;
    const GpsTime end = test::kSkyEpoch.plus_seconds(static_cast<double>(samples) / 200.0);
    watched.receive(Channel::kOdometer,
                    encoder.encode(OdometerIncrement{end, 100'000'000, 0.0}, ++increments));
    if (samples == 6000) watched.at(30.0);
    return true;
  });
  CHECK(watched.at(32.0).find("odometer") == std::string::npos);
  CHECK(watched.at(34.0).find("no usable odometer") != std::string::npos);
  CHECK(watched.message().odometer_age_s == Approx(30.0).margin(0.02));
}

TEST_CASE("a restart takes the source with it, until there is an answer again") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    CAPTURE(static_cast<int>(motion));
    Watched watched(motion);
    Encoder encoder;
    int epochs = 0;
    std::string before, after, later;
    watched.feed([&](Channel channel) {
      if (channel != Channel::kGnssEpoch) return true;
      ++epochs;
      if (epochs == 41) later = watched.at(41.0) + watched.message().source;
      if (epochs != 40) return true;
      before = watched.at(40.0) + watched.message().source;
      watched.receive(Channel::kCommand, encoder.encode(Command(), test::kSkyEpoch, 1));
      after = watched.at(40.0) + watched.message().source;
      return true;
    });
    CHECK(before == "OK: ekf");
    const std::string started_over =
        "the filter has started over (by the command restart): normal once after an outage or a "
        "command (the events filter_reset have the numbers)";
    CHECK(after.find("FAULT: no solution yet (") == 0);
    CHECK(after.find(started_over + "none") != std::string::npos);
    const bool inertial = motion == MotionModel::kInertial;
    CHECK(later ==
          (inertial
               ? "DEGRADED: aligning (no heading: drive faster than 1 m/s for 3 s, or set_heading)"
                 "; " +
                     started_over + "aligning"
               : "DEGRADED: " + started_over + "ekf"));
    CHECK(watched.at(60.0) == "DEGRADED: " + started_over);
    CHECK(watched.message().source == "ekf");
  }
}

TEST_CASE("a journal that cannot be written is a FAULT in HEALTH, and none of the answer") {
  const test::TemporaryFile folder("unused", "");
  std::atomic<bool> fails{true};
  const std::string path = folder.beside("run.journal");
  Watched watched(MotionModel::kConstantVelocity, false, {}, path,
                  [&](DiskCall) { return fails ? EROFS : 0; });
  watched.feed(all_but_imu);
  CHECK(watched.at(60.0) == "FAULT: journal (" + path +
                                ": cannot be written: Read-only file system): look at space and "
                                "permissions of its disk");
  CHECK(watched.fault() == Fault::kNone);
  fails = false;
  while (!watched.engine()->journal().failure().empty()) test::wait_a_moment();
  // It stays for a while.
  CHECK(watched.at(61.0).starts_with("FAULT: journal ("));
  watched.receive(Channel::kCommand, Encoder().encode(Command(), test::kSkyEpoch, 1));
  watched.at(62.0);
  CHECK(watched.fault() == Fault::kNavigation);
}

TEST_CASE("levels are in HEALTH, and those above their alert limits degrade it") {
  IntegrityConfig integrity;
  integrity.horizontal_alert_limit_m = 1000.0;
  integrity.vertical_alert_limit_m = 0.01;
  Watched watched(MotionModel::kInertial, false, integrity);
  watched.at(0.5);
  CHECK(std::isnan(watched.message().horizontal_protection_m));
  watched.feed(everything);
  const std::string said = watched.at(60.0);
  const double vertical_m = watched.message().vertical_protection_m;
  CHECK(watched.message().schema == 2);
  CHECK(watched.message().horizontal_protection_m > 0.01);
  CHECK(watched.message().horizontal_protection_m < 1000.0);
  CHECK(vertical_m > 0.01);
  CHECK(watched.message().heading_protection_rad > 0.0);
  CHECK(watched.message().heading_protection_rad <= 3.15);
  CHECK(
      said ==
      "DEGRADED: protection level (vertical above its alert limit of 0.01 m): use the solution for "
      "nothing that needs this accuracy");
  // An answer that has ended has no level.
  watched.at(75.0);
  CHECK(watched.message().source == "none");
  CHECK(std::isnan(watched.message().vertical_protection_m));
}

TEST_CASE("what is learned about errors is in HEALTH") {
  Watched watched(MotionModel::kInertial);
  watched.feed(everything);
  watched.at(60.0);
  const auto count = [&](const std::string& name) {
    for (const count_t& entry : watched.message().counts)
      if (entry.name == name) return entry.value;
    return std::int64_t{0};
  };
  for (const std::string of : {"code", "doppler"}) {
    CAPTURE(of);
    CHECK(count("learned " + of + " sigma %") >= 100);
    CHECK(count("learned " + of + " sigma %") <= 3000);
    CHECK(count("learned " + of + " time ms") >= 1000);
    CHECK(count("learned " + of + " sigma % Galileo") >= 100);
    CHECK(count("learned " + of + " sigma % over 10 dB weaker") >= 100);
    CHECK(count("learned " + of + " time ms above 50 deg") >= 1000);
    CHECK(count("learned " + of + " time ms Galileo") == 0);  // not by system
  }
}

TEST_CASE("an input that does not follow a convention stays a reason, with the remedy") {
  Watched watched(MotionModel::kInertial);
  Decoder decoder;
  Encoder encoder;
  const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(60.0));
  test::feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
    ImuSample sample;
    if (channel != Channel::kImu) return watched.receive(channel, bytes);
    const DecodeResult result = decoder.decode(bytes, &sample);
    REQUIRE(result.fault == InputFault::kNone);
    sample.delta_velocity_b /= 9.80665;
    watched.receive(channel, encoder.encode(sample, result.sequence));
  });
  for (const double now_s : {60.0, 60.5}) {
    const std::string said = watched.at(now_s);
    CAPTURE(said);
    CHECK(said.find("DEGRADED: ") == 0);
    CHECK(said.find("accelerations in g, multiply them by 9.80665") != std::string::npos);
  }
}

TEST_CASE("precise orbits 15 m off the broadcast ones degrade HEALTH, and are counted") {
  Watched watched(MotionModel::kInertial);
  Encoder encoder;
  const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(60.0));
  std::uint64_t sequence = 0;
  for (int s = -300; s <= 360; s += 30) {
    std::vector<PreciseState> nodes;
    for (const Ephemeris& e : drive.ephemerides) {
      if (e.satellite.system == System::kLeo) continue;
      nodes.push_back(test::product_node(e, test::kSkyEpoch.plus_seconds(s)));
      nodes.back().p_e += 15.0 * nodes.back().p_e.unitOrthogonal();
    }
    watched.receive(Channel::kOrbitClock, encoder.encode(nodes, ++sequence));
  }
  watched.feed(everything);
  CHECK(
      watched.at(60.0) ==
      "DEGRADED: precise orbits contradict the broadcast ones: look at the sources of corrections "
      "and ephemerides (the broadcast ones are used)");
  const auto& counts = watched.message().counts;
  const auto refused = std::find_if(counts.begin(), counts.end(), [](const count_t& count) {
    return count.name == "orbits refused";
  });
  REQUIRE(refused != counts.end());
  CHECK(refused->value >= 5);
}

TEST_CASE("a daemon without ephemerides says so instead of only `no solution yet`") {
  Watched watched(MotionModel::kInertial);
  watched.feed([](Channel channel) { return channel != Channel::kEphemeris; });
  CHECK(watched.at(60.0) ==
        "FAULT: no solution yet (most satellites have no ephemeris: see that they are sent)");
}

TEST_CASE("junk beside good inputs degrades HEALTH for as long as it comes, and five seconds") {
  Watched watched(MotionModel::kInertial);
  const std::vector<std::uint8_t> junk(60, 0x55);
  int samples = 0;
  std::string with_junk, soon_after, long_after;
  watched.feed([&](Channel channel) {
    if (channel != Channel::kImu) return true;
    ++samples;
    if (samples > 6000 && samples <= 7000) watched.receive(Channel::kOdometer, junk);
    if (samples % 200 != 0) return true;
    const std::string said = watched.at(samples / 200);
    if (samples == 7000) with_junk = said;
    if (samples == 7600) soon_after = said;
    if (samples == 11800) long_after = said;
    return true;
  });
  const std::string reason =
      "a tenth or more of an input is rejected (ODOMETER as undecodable): look at its sender and "
      "the events rejected_input";
  CHECK(with_junk == "DEGRADED: " + reason);
  CHECK(soon_after == "DEGRADED: " + reason);
  CHECK(long_after == "OK: ");
}

struct Stretch {
  int begin_s = 0, end_s = 45;
};

// Feeds a stretch of the drive with the messages of `channel` changed from `changed_s` on, looks
// once a second, and returns what HEALTH said last.
template <typename Input, typename Change>
static std::string said_with(Channel changed, Watched* watched, Change change, int changed_s,
                             Stretch stretch) {
  Decoder decoder;
  Encoder encoder;
  const test::SyntheticDrive drive = test::synthetic_drive(test::noisy_drive(60.0));
  int samples = 0;
  std::string said;
  test::feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
    samples += channel == Channel::kImu;
    const bool is_before = stretch.begin_s > 0 && samples <= stretch.begin_s * 200;
    if (is_before || samples > stretch.end_s * 200) return;
    if (channel == changed) {
      Input input;
      const DecodeResult result = decoder.decode(bytes, &input);
      REQUIRE(result.fault == InputFault::kNone);
      if (samples > changed_s * 200) change(&input);
      watched->receive(channel, encoder.encode(input, result.sequence));
    } else {
      watched->receive(channel, bytes);
    }
    if (channel == Channel::kImu && samples % 200 == 0) said = watched->at(samples / 200);
  });
  return said;
}

template <typename Change>
static std::string said_with_imu(Watched* watched, Change change, int changed_s = 30) {
  return said_with<ImuSample>(Channel::kImu, watched, change, changed_s, {});
}

TEST_CASE("a dead IMU is named with its own fault, whatever else is rejected more often") {
  Watched watched(MotionModel::kInertial);
  const std::vector<std::uint8_t> junk(60, 0x55);
  const std::string said = said_with_imu(&watched, [&](ImuSample* sample) {
    sample->delta_theta_b.setZero();
    sample->delta_velocity_b.setZero();
    for (int i = 0; i < 3; ++i) watched.receive(Channel::kOdometer, junk);
  });
  CAPTURE(said);
  CHECK(said.find("no usable IMU (messages come, but are rejected as not_sane): ") !=
        std::string::npos);
  CHECK(said.find("is rejected (IMU as not_sane, ODOMETER as undecodable): ") != std::string::npos);
}

namespace {

const std::string kApart = "their time is not that of the IMU: compare the two clocks); ";
const auto an_hour_ahead = [](ImuSample* sample) {
  sample->time = sample->time.plus_seconds(3600.0);
};
const auto an_hour_behind = [](RawEpoch* epoch) {
  epoch->time = epoch->time.plus_seconds(-3600.0);
};

}  // namespace

TEST_CASE("an IMU whose clock is an hour ahead: HEALTH says so while GNSS alone answers") {
  const int since_s = GENERATE(0, 30);
  Watched watched(MotionModel::kInertial);
  const std::string said = said_with_imu(&watched, an_hour_ahead, since_s);
  CAPTURE(said);
  CHECK(
      said.find("DEGRADED: aligning (no IMU sample is used); no usable IMU (messages come, but are "
                "rejected as too_far_ahead): ") == 0);
  CHECK(said.find("the IMU's stamps are 3.6e+03 s off the GNSS stamps: ") != std::string::npos);
}

TEST_CASE("a restart while GNSS is an hour behind the time of both: HEALTH says so") {
  Watched watched(MotionModel::kInertial);
  const auto said_until = [&](Stretch stretch) {
    return said_with<RawEpoch>(Channel::kGnssEpoch, &watched, an_hour_behind, 30, stretch);
  };
  CHECK(
      said_until({}).find("no usable GNSS (messages come, but are rejected as time_backwards): ") !=
      std::string::npos);
  watched.receive(Channel::kCommand, Encoder().encode(Command(), GpsTime(), 1));
  CHECK(watched.at(45.5).find("FAULT: no solution yet (") == 0);
  for (const int begin_s : {45, 47, 50}) {
    const std::string said = said_until({begin_s, begin_s + 2});
    CAPTURE(said);
    CHECK(said.find("FAULT: no solution yet (the GNSS epochs are rejected as time_backwards, " +
                    kApart) == 0);
  }
}

TEST_CASE("inputs that come back after 16 s: HEALTH waits for an epoch before it compares clocks") {
  Watched watched(MotionModel::kInertial);
  int samples = 0;
  std::string back, all;
  watched.feed([&](Channel channel) {
    if (channel == Channel::kImu) ++samples;
    // The epoch of 46 s comes before the IMU's new time is believed, that of 47 s after the look.
    if (channel == Channel::kImu && samples % 200 == 60) {
      const std::string said = watched.at(samples / 200.0);
      all += said + "\n";
      if (samples / 200 == 46) back = said;
    }
    return samples <= 30 * 200 || samples > 46 * 200;
  });
  CAPTURE(all);
  CHECK(back.find("FAULT: no solution yet (the filter has started over and waits for the next GNSS "
                  "epoch)") == 0);
  CHECK(back.find("rejected as too_far_ahead") != std::string::npos);
  CHECK(all.find("compare the two clocks") == std::string::npos);
}
