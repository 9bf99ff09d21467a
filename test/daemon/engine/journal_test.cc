// A journal is of use wherever it ends: every output stands behind the inputs that caused it.
#include <array>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <iostream>
#include <leonav/imu_t.hpp>
#include <leonav/solution_t.hpp>
#include <thread>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/engine/engine.h"
#include "daemon/messages/input_dispatch.h"
#include "daemon/messages/output_groups.h"
#include "discard.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Discard;
using Bytes = std::vector<std::uint8_t>;

struct Queues final : MessageTarget {
  std::array<std::deque<Bytes>, kOutputGroups.size()> groups;
  void take(Channel channel, ByteSpan bytes) override {
    const auto group = output_group(channel, bytes);
    if (group) groups[*group].emplace_back(bytes.begin(), bytes.end());
  }
};

// In bursts of a second, as fast as it goes, so that messages wait in every ring to `out`: this is
// where an output could overtake its cause. Only at the end of a burst, where the epoch is, the
// stages are waited for: otherwise a busy machine may miss every epoch and there is no output to
// look at.
void record(const std::string& path, double duration_s,
            DaemonConfig config = test::drive_config()) {
  config.journal.path = path;
  Discard target;
  Engine engine(config, &target);
  engine.start();
  test::feed_messages(test::synthetic_drive(test::noisy_drive(duration_s)),
                      [&](Channel channel, ByteSpan bytes) {
                        engine.receive(channel, bytes, 1);
                        if (channel != Channel::kGnssEpoch) return;
                        while (!engine.idle()) test::wait_a_moment();
                      });
  REQUIRE(engine.finish());
  REQUIRE(engine.counters().misses.get() == 0);
}

struct Recorded {
  Channel channel;
  Bytes data;
};

std::vector<Recorded> read(const std::string& path) {
  EventLogReader log(path);
  std::vector<Recorded> list;
  for (LogEvent event; log.next(&event);) {
    const auto channel = channel_from_name(event.channel);
    REQUIRE(channel.has_value());
    list.push_back({*channel, event.data});
  }
  return list;
}

template <typename Message>
std::int64_t time_of(const Bytes& bytes) {
  Message message{};
  const int size = static_cast<int>(bytes.size());
  REQUIRE(message.decode(bytes.data(), 0, size) == size);
  return message.time_ns;
}

}  // namespace

TEST_CASE("no solution is journaled before the IMU sample that it stands for") {
  const test::TemporaryFile folder("unused", "");
  record(folder.beside("journal.lcmlog"), 60.0);
  std::int64_t last_imu_ns = 0;
  std::uint64_t solutions = 0, too_early = 0;
  for (const Recorded& one : read(folder.beside("journal.lcmlog"))) {
    if (one.channel == Channel::kImu) last_imu_ns = time_of<imu_t>(one.data);
    if (one.channel != Channel::kSolution) continue;
    ++solutions;
    if (time_of<solution_t>(one.data) > last_imu_ns) ++too_early;
  }
  std::cout << "journal order: " << solutions << " solutions, " << too_early
            << " before their IMU sample\n";
  CHECK(solutions > 10'000);
  CHECK(too_early == 0);
}

TEST_CASE("whatever a journal holds, the inputs before it regenerate") {
  const test::TemporaryFile folder("unused", "");
  record(folder.beside("journal.lcmlog"), 30.0);
  Queues regenerated;
  EncodingSink sink(&regenerated);
  Navigator navigator(test::drive_config().navigator, &sink);
  InputDispatch dispatch(&navigator.sequencer());
  const std::vector<Recorded> journal = read(folder.beside("journal.lcmlog"));
  Decoder decoder;
  for (const Recorded& one : journal) {
    if (one.channel != Channel::kDecision) continue;
    Decision decision;
    REQUIRE(decoder.decode(one.data, &decision).fault == InputFault::kNone);
    navigator.record(decision);
  }
  std::uint64_t outputs = 0, without_cause = 0, different = 0;
  for (const Recorded& one : journal) {
    if (is_replayed(one.channel)) dispatch.dispatch(one.channel, one.data);
    const auto group = output_group(one.channel, one.data);
    if (!group) continue;
    ++outputs;
    std::deque<Bytes>& queue = regenerated.groups[*group];
    if (queue.empty()) {
      ++without_cause;
      continue;
    }
    if (queue.front() != one.data) ++different;
    queue.pop_front();
  }
  std::cout << "journal order: " << outputs << " outputs, " << without_cause
            << " before their cause\n";
  CHECK(outputs > 5'000);
  CHECK(without_cause == 0);
  CHECK(different == 0);
}

TEST_CASE("a journal cut between any two messages verifies; a clean one must hold every output") {
  const std::string replay = LEONAV_BIN_DIR "/leonav-replay";
  if (!std::filesystem::exists(replay)) {
    std::cout << "SKIPPED: " << replay << " is not built\n";
    return;
  }
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = load_preset("phone_imu", {"vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]"});
  config.threads = ThreadsConfig();
  config.threads.lock_memory = false;
  record(folder.beside("journal.lcmlog"), 15.0, config);
  std::vector<LogEvent> events;
  EventLogReader log(folder.beside("journal.lcmlog"));
  for (LogEvent event; log.next(&event);) events.push_back(event);
  const std::size_t all = events.size();
  REQUIRE(all > 4'000);
  CHECK(channel_from_name(events.back().channel) == Channel::kEnd);

  const auto verify = [&](std::size_t kept) {
    {
      EventLogWriter cut(folder.beside("cut.lcmlog"));
      for (std::size_t i = 0; i < kept; ++i) {
        REQUIRE(cut.write(events[i].timestamp_us, events[i].channel, events[i].data));
      }
      REQUIRE(cut.flush());
    }
    return std::system((replay + " --verify --out '" + folder.beside("replay") + "' '" +
                        folder.beside("cut.lcmlog") + "' >'" + folder.beside("text") + "' 2>&1")
                           .c_str());
  };
  CHECK(verify(all) == 0);
  for (const std::size_t lost : {1, 2, 3, 4, 10, 101, 202, 303, 404, 505, 1001, 2002}) {
    INFO(lost);
    CHECK(verify(all - lost) == 0);
    CHECK(std::system(("grep -q 'the journal was cut; regenerated beyond its end' '" +
                       folder.beside("text") + "'")
                          .c_str()) == 0);
  }
  // The last solution left out of a journal that says it is complete.
  std::size_t solution = all - 2;
  while (channel_from_name(events[solution].channel) != Channel::kSolution) --solution;
  events.erase(events.begin() + static_cast<std::ptrdiff_t>(solution));
  const auto end = encode_journal_end(static_cast<std::int64_t>(events.size() - 1));
  events.back().data.assign(end.begin(), end.end());
  CHECK(verify(events.size()) != 0);
  CHECK(std::system(
            ("grep -q 'outputs regenerated, but not recorded' '" + folder.beside("text") + "'")
                .c_str()) == 0);
}

TEST_CASE("a journal of an older version, a file's text with overrides beside it, replays") {
  if (!std::filesystem::exists(LEONAV_BIN_DIR "/leonav-replay")) {
    std::cout << "SKIPPED: leonav-replay is not built\n";
    return;
  }
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config =
      load_preset("phone_imu", {"gnss.elevation_mask_deg=25", "ekf.carrier=false"});
  config.threads = ThreadsConfig();
  config.threads.lock_memory = false;
  record(folder.beside("journal.lcmlog"), 15.0, config);
  // `text` and `overrides` instead of the effective text.
  const auto replayed = [&](const std::string& text, const std::vector<std::string>& overrides) {
    {
      EventLogReader log(folder.beside("journal.lcmlog"));
      EventLogWriter old(folder.beside("old.lcmlog"));
      for (LogEvent event; log.next(&event);) {
        if (channel_from_name(event.channel) == Channel::kConfig)
          event.data = encode(RunConfiguration{"leonavd 0.1.0", "a.yaml", text, overrides});
        REQUIRE(old.write(event.timestamp_us, event.channel, event.data));
      }
      REQUIRE(old.flush());
    }
    return test::run_program("leonav-replay", "--verify --out '" + folder.beside("replay") + "' '" +
                                                  folder.beside("old.lcmlog") + "'");
  };
  const std::string file = effective_text(load_preset("phone_imu").source);
  const auto right = replayed(file, {"gnss.elevation_mask_deg=25", "ekf.carrier=false"});
  INFO(right.err);
  CHECK(right.exit_code == 0);
  CHECK(right.out.find("configuration: a.yaml as recorded in ") == 0);
  CHECK(right.out.find(" 0 differences") != std::string::npos);
  CHECK(right.out.find("note:") == std::string::npos);
  // The overrides are obeyed.
  CHECK(replayed(file, {"ekf.carrier=false"}).exit_code == 1);
}

TEST_CASE("a restart leaves the journal of the run before it alone") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal.lcmlog");
  record(path, 2.0);
  const auto size = std::filesystem::file_size(path);
  REQUIRE(size > 1000);
  record(path, 1.0);
  record(path, 1.0);
  CHECK(std::filesystem::file_size(path) == size);
  for (const char* number : {".1", ".2"}) {
    REQUIRE(std::filesystem::exists(path + number));
    CHECK(read(path + number).back().channel == Channel::kEnd);
  }
  CHECK_FALSE(std::filesystem::exists(path + ".3"));
}

TEST_CASE("antenna models are in the journal and reach the stage that replays it") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("journal.lcmlog");
  AntennaPattern antenna;
  antenna.is_receiver = true;
  antenna.band = '2';
  antenna.offset_m = {0.001, -0.002, 0.118};
  {
    Discard target;
    Engine engine(config, &target);
    engine.start();
    Encoder encoder;
    engine.receive(Channel::kAntenna, encoder.encode(antenna, GpsTime(), 1), 1);
    antenna.is_receiver = false;
    antenna.satellite = {System::kLeo, 7};
    engine.receive(Channel::kAntenna, encoder.encode(antenna, GpsTime(), 2), 1);
    REQUIRE(engine.finish());
  }
  Queues outputs;
  EncodingSink sink(&outputs);
  Navigator navigator(config.navigator, &sink);
  InputDispatch dispatch(&navigator.sequencer());
  std::uint64_t inputs = 0;
  for (const Recorded& one : read(config.journal.path)) {
    if (!is_input(one.channel)) continue;
    dispatch.dispatch(one.channel, one.data);
    ++inputs;
  }
  CHECK(inputs == 2);
  const AntennaPatternStore& antennas = navigator.gnss().antennas();
  CHECK(antennas.counters().added == 2);  // the LEO satellite's is one of them
  const AntennaRange up = antennas.receiver_range(System::kGps, '2', Eigen::Vector3d(0, 0, -1));
  CHECK(up.status == AntennaStatus::kOk);
  CHECK(up.range_m == Approx(-0.118));
}
