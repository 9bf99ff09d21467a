// A third of the epochs miss their deadline, forced: the answers go on, each miss is told, and the
// journal replays byte for byte.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <leonav/event_t.hpp>
#include <leonav/solution_t.hpp>
#include <set>
#include <thread>
#include <vector>

#include "daemon/config/load_config.h"
#include "daemon/engine/engine.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

bool must_miss(std::uint64_t epoch) { return epoch % 3 == 0; }

// Sees every output in the thread `out`, and so the moment at which an epoch has been decided.
struct Observer final : MessageTarget {
  std::atomic<std::uint64_t> last_decided{0};
  std::set<std::uint64_t> missed, missed_by_event;
  std::uint64_t commits = 0, outputs = 0;
  std::vector<std::int64_t> solution_times;

  void take(Channel channel, ByteSpan bytes) override {
    ++outputs;
    const int size = static_cast<int>(bytes.size());
    if (channel == Channel::kDecision) {
      Decision decision;
      if (decoder.decode(bytes, &decision).fault != InputFault::kNone) std::abort();
      if (decision.committed) ++commits;
      if (!decision.committed) missed.insert(decision.epoch);
      last_decided = decision.epoch;
    } else if (channel == Channel::kEvent) {
      event_t event{};
      if (event.decode(bytes.data(), 0, size) != size) std::abort();
      if (event.kind == static_cast<int>(EventKind::kDeadlineMiss)) {
        missed_by_event.insert(static_cast<std::uint64_t>(event.value));
      }
    } else if (channel == Channel::kSolution) {
      solution_t solution{};
      if (solution.decode(bytes.data(), 0, size) != size) std::abort();
      solution_times.push_back(solution.time_ns);
    }
  }

 private:
  Decoder decoder;
};

void run_with_misses(const DaemonConfig& config, Observer* observer) {
  std::atomic<std::uint64_t> held{0};  // the epoch that is made to miss
  std::atomic<bool> ended{false};
  EngineHooks hooks;
  // The worker sleeps until the navigator has given the epoch up: no clock is involved.
  hooks.before_epoch = [&](std::uint64_t epoch) {
    if (!must_miss(epoch)) return;
    held = epoch;
    while (observer->last_decided < epoch && !ended) test::wait_a_moment();
  };
  Engine engine(config, observer, hooks);
  engine.start();
  std::int64_t stamp = 0;
  test::feed_messages(
      test::synthetic_drive(test::noisy_drive(60.0)), [&](Channel channel, ByteSpan bytes) {
        engine.receive(channel, bytes, ++stamp);
        // Once the miss is decided the worker is waited for again, however late
        // a busy machine wakes it: no other epoch misses.
        while (!(held > observer->last_decided ? engine.idle_but_gnss() : engine.idle()))
          test::wait_a_moment();
      });
  ended = true;
  REQUIRE(engine.finish());
  CHECK(engine.counters().misses.get() == static_cast<std::int64_t>(observer->missed.size()));
  CHECK(engine.counters().commits.get() == static_cast<std::int64_t>(observer->commits));
}

}  // namespace

TEST_CASE("a third of the epochs miss: answers go on, all is reported, and it replays") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("journal.lcmlog");
  DaemonConfig config = load_preset("phone_imu", {"vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]"});
  config.threads = ThreadsConfig();
  config.threads.lock_memory = false;
  config.journal.path = journal;
  Observer observer;
  run_with_misses(config, &observer);

  std::set<std::uint64_t> expected;
  for (std::uint64_t epoch = 1; epoch <= observer.last_decided; ++epoch) {
    if (must_miss(epoch)) expected.insert(epoch);
  }
  CHECK(expected.size() >= 19);
  CHECK(observer.missed == expected);
  CHECK(observer.missed_by_event == observer.missed);
  CHECK(observer.commits == observer.last_decided - observer.missed.size());
  REQUIRE(observer.solution_times.size() > 9'000);
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < observer.solution_times.size(); ++i) {
    longest = std::max(longest, observer.solution_times[i] - observer.solution_times[i - 1]);
  }
  CHECK(longest <= 5'000'001);  // one IMU interval
  std::cout << "forced misses: " << observer.missed.size() << " of " << observer.last_decided
            << " epochs, " << observer.solution_times.size() << " solutions, longest pause "
            << static_cast<double>(longest) * 1e-6 << " ms\n";

  const std::string replay = LEONAV_BIN_DIR "/leonav-replay";
  if (!std::filesystem::exists(replay)) {
    std::cout << "SKIPPED: " << replay << " is not built\n";
    return;
  }
  // Neither --config nor --preset: the journal holds it.
  const std::string command = replay + " --verify --out '" + folder.beside("replay") + "' '" +
                              journal + "' 2>&1 | grep -E '^(verified|note|failure)'";
  CHECK(std::system(("test \"$(" + command + ")\" = 'verified " + std::to_string(observer.outputs) +
                     " outputs, 0 differences'")
                        .c_str()) == 0);
  CHECK(std::system(command.c_str()) == 0);
  // Another configuration is told as the reason of the differences.
  CHECK(std::system((replay + " --verify --set gnss.elevation_mask_deg=30 --out '" +
                     folder.beside("other") + "' '" + journal +
                     "' 2>&1 | grep -q 'failure: .*the journal was written with --set "
                     "gnss.elevation_mask_deg=10'")
                        .c_str()) == 0);
}
