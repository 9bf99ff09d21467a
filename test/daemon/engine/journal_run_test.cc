// The journal of a running engine: a disk that blocks costs no answer; pieces, fewer outputs and
// counted junk replay to the same bytes.
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>

#include "core/navigator/interface/event_limiter.h"
#include "daemon/config/load_config.h"
#include "daemon/engine/engine.h"
#include "daemon/health/health_monitor.h"
#include "daemon/health/thread_monitor.h"
#include "drivers/lcm/event_header.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "engine_runs.h"
#include "support/has.h"
#include "support/programs/program_run.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Bytes;
using test::Collector;
using test::has;
using test::Input;

DaemonConfig journaled(const std::string& path, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all = {"vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]",
                                  text_override("journal.path", path), "journal.buffer_mb=64",
                                  "realtime.lock_memory=false"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  DaemonConfig config = load_preset("phone_imu", all);
  config.threads = ThreadsConfig();
  config.threads.lock_memory = false;
  return config;
}

// Feeds a drive, with the stages waited for at each epoch, so that none is missed.
template <typename Each>
void feed(Engine* engine, double duration_s, Each each) {
  test::feed_messages(test::synthetic_drive(test::noisy_drive(duration_s)),
                      [&](Channel channel, ByteSpan bytes) {
                        engine->receive(channel, bytes, 1);
                        if (channel != Channel::kGnssEpoch) return;
                        while (!engine->idle()) test::wait_a_moment();
                        each();
                      });
}

test::ProgramRun replay(const test::TemporaryFile& folder, const std::string& log) {
  return test::run_program("leonav-replay",
                           "--verify --out '" + folder.beside("out") + "' '" + log + "'");
}

// The events of the journal of a drive.
std::vector<LogEvent> recorded(const test::TemporaryFile& folder,
                               const std::vector<std::string>& overrides) {
  const std::string path = folder.beside("run.journal");
  std::filesystem::remove(path);
  {
    Collector published;
    Engine engine(journaled(path, overrides), &published);
    engine.start();
    feed(&engine, 20.0, [] {});
    REQUIRE(engine.finish());
  }
  std::vector<LogEvent> events;
  EventLogReader log(path);
  for (LogEvent event; log.next(&event);) events.push_back(event);
  return events;
}

std::vector<std::size_t> places(const std::vector<LogEvent>& events, Channel channel) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < events.size(); ++i)
    if (channel_from_name(events[i].channel) == channel) list.push_back(i);
  return list;
}

// The numbers of the events of a channel in one file of a journal.
std::vector<std::int64_t> numbers_of(const std::string& file, Channel channel) {
  std::vector<std::int64_t> numbers;
  EventFileReader log(file);
  for (LogEvent event; log.next(&event);)
    if (channel_from_name(event.channel) == channel) numbers.push_back(event.number);
  return numbers;
}

// Puts a HEALTH, which is not compared, into the place of an event.
void take_out(const std::string& file, std::int64_t number) {
  std::string bytes;
  EventFileReader log(file);
  for (LogEvent event; log.next(&event);) {
    if (event.number == number) event.channel = channel_name(Channel::kHealth);
    const EventHeaderBytes header = encode_event_header(
        {event.number, event.timestamp_us, static_cast<std::uint32_t>(event.channel.size()),
         static_cast<std::uint32_t>(event.data.size())});
    bytes.append(header.begin(), header.end()).append(event.channel);
    bytes.append(event.data.begin(), event.data.end());
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

auto at(std::vector<LogEvent>* events, std::size_t place) {
  return events->begin() + static_cast<std::ptrdiff_t>(place);
}

// Replays the events as a journal, whose end mark counts them.
test::ProgramRun verify(const test::TemporaryFile& folder, const std::vector<LogEvent>& list) {
  EventLogWriter changed(folder.beside("changed"));
  for (const LogEvent& event : list) {
    const auto end = encode_journal_end(changed.events());
    const bool is_end = channel_from_name(event.channel) == Channel::kEnd;
    REQUIRE(changed.write(event.timestamp_us, event.channel, is_end ? ByteSpan(end) : event.data));
  }
  REQUIRE(changed.flush());
  return replay(folder, folder.beside("changed"));
}

}  // namespace

TEST_CASE("while the disk blocks, SOLUTION and HEALTH go on, and no thread counts as hanging") {
  const test::TemporaryFile folder("unused", "");
  std::mutex mutex;
  std::condition_variable changed;
  bool blocked = false, is_waiting = false;
  EngineHooks hooks;
  hooks.disk_call = [&](DiskCall) {
    std::unique_lock lock(mutex);
    is_waiting = blocked;
    changed.notify_all();
    changed.wait(lock, [&] { return !blocked; });
    return 0;
  };
  const DaemonConfig config = journaled(folder.beside("run.journal"), {"journal.buffer_mb=1"});
  Collector outputs;
  Engine engine(config, &outputs, hooks);
  engine.start();
  HealthMonitor health(&engine, config.navigator);
  ThreadMonitor threads(&engine, config.navigator);
  {
    const std::lock_guard lock(mutex);
    blocked = true;
  }
  double now_s = 0.0;
  std::string hanging;
  bool told = false;
  feed(&engine, 30.0, [&] {
    {
      // The journal's thread waits for the disk with what the first epoch brought: a thread that
      // comes later would hold all that has come until then, outside its queue.
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return is_waiting; });
    }
    engine.publish(Channel::kHealth, health.next(now_s += 1.0));
    told = told || has(health.why(), "journal: messages are lost");
    hanging += threads.stalled_threads();
  });
  // Nothing has come back from the disk, and all is published.
  while (!engine.idle()) test::wait_a_moment();
  CHECK(outputs.groups[0].size() > 4'000);
  CHECK(outputs.groups[2].size() >= 28);
  CHECK(engine.counters().unpublished.get() == 0);
  CHECK(hanging.find("out") == std::string::npos);
  CHECK(engine.journal().counters().lost_others.get() > 0);
  // The last ones may have been lost since the last look.
  health.next(now_s += 1.0);
  CHECK((told || has(health.why(), "journal: messages are lost")));
  while (!engine.journal().is_stalled()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  health.next(now_s += 1.0);
  CHECK(has(health.why(), "journal: the disk does not answer"));
  {
    const std::lock_guard lock(mutex);
    blocked = false;
  }
  changed.notify_all();
  CHECK_FALSE(engine.finish());
  CHECK(has(engine.journal().error(), "messages are missing"));
  if (!test::have_programs("leonav-replay")) return;
  // Up to the place it is the run.
  const auto run = replay(folder, config.journal.path);
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, " 0 differences"));
  CHECK(has(run.out, "the journal has messages missing; regenerated behind the first of them: "));
  CHECK(has(run.err, "messages are missing which the disk did not take in time"));
}

TEST_CASE("pieces replay byte for byte as one journal, with any of journal.outputs") {
  if (!test::have_programs("leonav-replay")) return;
  std::uintmax_t all_bytes = 0;
  for (const std::string outputs : {"all", "thinned", "none"}) {
    INFO(outputs);
    const test::TemporaryFile folder("unused", "");
    const std::string journals = folder.beside("journals");
    std::filesystem::create_directory(journals);
    const std::string path = journals + "/run.journal";
    Collector published;
    {
      Engine engine(journaled(path, {"journal.outputs=" + outputs, "journal.piece_mb=0.1",
                                     "journal.flush_interval_s=0.01"}),
                    &published);
      engine.start();
      feed(&engine, 30.0, [] {});
      REQUIRE(engine.finish());
      REQUIRE(engine.counters().misses.get() == 0);
      CHECK(engine.journal().counters().pieces.get() >= 5);
    }
    std::uintmax_t bytes = 0, pieces = 0;
    for (const auto& entry : std::filesystem::directory_iterator(journals)) {
      bytes += entry.file_size();
      ++pieces;
    }
    std::cout << "journal.outputs " << outputs << ": " << bytes << " bytes in " << pieces
              << " pieces\n";
    if (outputs == "all") all_bytes = bytes;
    if (outputs == "thinned") CHECK(bytes < 3 * all_bytes / 4);
    for (const std::string& log : {path, journals}) {
      const auto run = replay(folder, log);
      INFO(run.out << run.err);
      CHECK(run.exit_code == 0);
      CHECK(has(run.out, " 0 differences"));
      CHECK_FALSE(has(run.out, "the journal was cut"));
      CHECK(has(run.out, "not in the journal, and so not compared: ") == (outputs != "all"));
      CHECK(has(run.out, "output SOLUTION: " + std::to_string(published.groups[0].size())));
    }
    // From a later piece on: an answer, and what it is worth.
    const auto late = replay(folder, path + ".part0003");
    CHECK(late.exit_code == 1);
    CHECK(has(late.err,
              "the log begins with piece 3 of its run, and no piece can be replayed as it ran"));
    CHECK(has(late.err, "nothing to verify: the journal lacks the beginning of its run"));
    // A piece that is gone in the middle.
    std::filesystem::remove(path + ".part0003");
    const auto broken = replay(folder, path);
    INFO(broken.out << broken.err);
    CHECK(broken.exit_code == 0);
    CHECK(has(broken.out, " 0 differences"));
    CHECK(has(broken.err, " messages are missing with pieces that are gone"));
  }
}

TEST_CASE("journal.outputs changes while it runs: each piece is compared by its own value") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  DaemonConfig config = journaled(path);
  const std::map<int, JournalOutputs> changes = {
      {7, JournalOutputs::kNone}, {14, JournalOutputs::kThinned}, {21, JournalOutputs::kAll}};
  Collector published;
  {
    Engine engine(config, &published);
    engine.start();
    const Gauge& pieces = engine.journal().counters().pieces;
    int epoch = 0;
    feed(&engine, 30.0, [&] {
      const auto change = changes.find(++epoch);
      if (change == changes.end()) return;
      config.journal.outputs = change->second;
      engine.journal().set_limits(limits_of(config.journal));
      // With the next message.
      const std::int64_t before = pieces.get();
      for (int i = 0; i < 10'000 && pieces.get() == before; ++i) {
        engine.publish(Channel::kHealth, Bytes(8));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    REQUIRE(engine.finish());
    REQUIRE(pieces.get() == 4);
  }
  const std::vector<std::string> files = {path, path + ".part0002", path + ".part0003",
                                          path + ".part0004"};
  const std::vector<RecordedOutputs> outputs = {RecordedOutputs::kAll, RecordedOutputs::kNone,
                                                RecordedOutputs::kThinned, RecordedOutputs::kAll};
  for (std::size_t i = 0; i < files.size(); ++i)
    CHECK(EventLogReader(files[i]).first_piece().value().outputs == outputs[i]);
  CHECK(numbers_of(files[1], Channel::kSolution).empty());
  CHECK(numbers_of(files[2], Channel::kSolution).size() <= 8);
  CHECK(numbers_of(files[3], Channel::kSolution).size() > 1000);
  const auto run = replay(folder, path);
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, " 0 differences"));
  CHECK(has(run.out, "not in the journal, and so not compared: "));
  CHECK(has(run.out, "output SOLUTION: " + std::to_string(published.groups[0].size())));

  // In each piece a missing output is a difference if that piece was to hold it.
  for (const auto& [file, channel] :
       std::vector<std::pair<std::string, Channel>>{{files[0], Channel::kSolution},
                                                    {files[1], Channel::kDecision},
                                                    {files[2], Channel::kSolution},
                                                    {files[2], Channel::kEpoch},
                                                    {files[3], Channel::kSolution},
                                                    {files[3], Channel::kEpoch}}) {
    const std::vector<std::int64_t> numbers = numbers_of(file, channel);
    REQUIRE(numbers.size() >= 4);
    const std::string kept = folder.beside("kept");
    std::filesystem::copy_file(file, kept, std::filesystem::copy_options::overwrite_existing);
    take_out(file, numbers[numbers.size() / 2]);
    const auto lacks = replay(folder, path);
    INFO(file << " " << name_of(channel) << "\n" << lacks.out << lacks.err);
    CHECK(lacks.exit_code == 1);
    CHECK_FALSE(has(lacks.out, " 0 differences"));
    std::filesystem::rename(kept, file);
  }
}

TEST_CASE("a difference in a thinned journal is found, and one SOLUTION too many or too few") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::vector<LogEvent> events = recorded(folder, {"journal.outputs=thinned"});
  const std::vector<std::size_t> solutions = places(events, Channel::kSolution);
  REQUIRE(solutions.size() >= 15);
  REQUIRE(solutions.size() <= 21);
  CHECK(verify(folder, events).exit_code == 0);
  auto other = events;
  other[solutions[9]].data[60] ^= 1;
  const auto differs = verify(folder, other);
  CHECK(differs.exit_code == 1);
  CHECK(has(differs.err, "SOLUTION message 10 at byte 60"));
  other = events;
  other.insert(at(&other, solutions[9]), events[solutions[9]]);
  CHECK(verify(folder, other).exit_code == 1);
  other = events;
  other.erase(at(&other, solutions[9]));
  CHECK(verify(folder, other).exit_code == 1);
}

TEST_CASE("as many SOLUTION may be missing as the marks LOST say, where they say it") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  for (const std::string outputs : {"all", "thinned"}) {
    INFO(outputs);
    const std::vector<LogEvent> events = recorded(folder, {"journal.outputs=" + outputs});
    const std::vector<std::size_t> solutions = places(events, Channel::kSolution);
    const auto mark = [&](std::uint64_t lost, std::uint64_t sequence) {
      const auto bytes = encode_lost({lost, 0}, sequence);
      return LogEvent{0, 1, "LEONAV_LOST", Bytes(bytes.begin(), bytes.end())};
    };
    // Without SOLUTION `first` to `first` + 2, and a mark before the next one, or before the end.
    const auto without = [&](std::size_t first, std::uint64_t lost) {
      auto some = events;
      const std::size_t behind =
          first + 3 < solutions.size() ? solutions[first + 3] : events.size() - 1;
      some.insert(at(&some, behind), mark(lost, behind == events.size() - 1 ? 0 : 1));
      for (const std::size_t one : {2, 1, 0}) some.erase(at(&some, solutions[first + one]));
      return verify(folder, some);
    };
    for (const std::size_t first : {std::size_t{8}, solutions.size() - 3}) {
      const auto right = without(first, 3);
      INFO(first << ": " << right.out << right.err);
      CHECK(right.exit_code == 0);
      CHECK(has(right.out, " 0 differences"));
      for (const std::uint64_t wrong : {0, 2, 4}) CHECK(without(first, wrong).exit_code == 1);
    }
    CHECK(has(without(solutions.size() - 3, 4).err, "1 more were left out of the journal"));
  }
}

TEST_CASE(
    "junk is counted in the journal, and its events replay among the inputs where they were") {
  const test::TemporaryFile folder("unused", "");
  const DaemonConfig config = journaled(folder.beside("run.journal"));
  Collector published;
  std::uint64_t junk = 0, junk_bytes = 0;
  std::array<std::uint64_t, kInputFaultCount> refused{};
  {
    Engine engine(config, &published);
    engine.start();
    const auto refuse = [&](Channel channel, const Bytes& bytes, InputFault fault) {
      engine.receive(channel, bytes, 1);
      ++refused[static_cast<std::size_t>(fault)];
      ++junk;
      junk_bytes += bytes.size();
    };
    Encoder encoder;
    test::feed_messages(
        test::synthetic_drive(test::noisy_drive(20.0)), [&](Channel channel, ByteSpan bytes) {
          engine.receive(channel, bytes, 1);
          if (channel == Channel::kGnssEpoch) {
            while (!engine.idle()) test::wait_a_moment();
            refuse(Channel::kGnssEpoch, Bytes(bytes.begin(), bytes.end() - 1),
                   InputFault::kUndecodable);
            // Told by itself and also known by the Sequencer, with a count of its own.
            ImuSample wild;
            wild.time = GpsTime::from_nanoseconds(1'000'000'000);
            wild.interval_ns = 5'000'000;
            wild.delta_theta_b.x() = 1e-3;
            engine.receive(Channel::kImu, encoder.encode(wild, 1), 1);
          }
          if (channel != Channel::kImu) return;
          refuse(Channel::kImu, Bytes(30'000, 0x55), InputFault::kUndecodable);
          refuse(Channel::kOdometer, Bytes(wire::kMaxMessageBytes + 1, 1), InputFault::kTooMany);
          Bytes schema(bytes.begin(), bytes.end());
          schema[wire::kSchemaOffset + 3] = 99;
          refuse(Channel::kImu, schema, InputFault::kUnknownSchema);
        });
    REQUIRE(engine.finish());
    REQUIRE(engine.counters().misses.get() == 0);
    for (std::size_t i = 0; i < kInputFaultCount; ++i)
      CHECK(engine.counters().rejected[i].get() >= static_cast<std::int64_t>(refused[i]));
    std::int64_t counted = 0;
    for (const Gauge& gauge : engine.counters().refused) counted += gauge.get();
    CHECK(counted == static_cast<std::int64_t>(junk));
  }
  const std::vector<Input> inputs = test::read_journal_inputs(config.journal.path);
  std::uint64_t marks = 0, counted = 0;
  for (const Input& input : inputs) {
    if (input.channel != Channel::kRefused) continue;
    ++marks;
    counted += decode_refused(input.bytes).value().count;
  }
  const auto size = std::filesystem::file_size(config.journal.path);
  std::cout << "junk: " << junk << " messages, " << junk_bytes << " bytes; the journal has "
            << marks << " marks in " << size << " bytes\n";
  CHECK(counted == junk);
  CHECK(marks < 3 * (16 + junk / 256) + 30);
  CHECK(size < 20'000'000);
  CHECK(junk_bytes > 100'000'000);
  // Every event is there, with its number and its time.
  test::check_same(test::run_navigator(config.navigator, inputs, {}), published);
  if (!test::have_programs("leonav-replay")) return;
  const auto run = replay(folder, config.journal.path);
  INFO(run.out << run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, " 0 differences"));
  CHECK(has(run.out, "rejected too_many: " + std::to_string(refused[7])));
}
