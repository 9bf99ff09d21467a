// A restart while the filter is at work: the threads, Navigator and the journal agree on its
// effect.
#include <algorithm>
#include <atomic>
#include <leonav/solution_t.hpp>
#include <thread>
#include <vector>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Collector;
using test::Input;

constexpr std::uint64_t kHeldEpoch = 40;

// The drive, with a restart right behind one epoch.
std::vector<Input> drive_with_restart() {
  std::vector<Input> list;
  Encoder encoder;
  std::uint64_t epochs = 0;
  const auto add = [&](Channel channel, ByteSpan bytes) {
    list.push_back({channel, {bytes.begin(), bytes.end()}});
  };
  test::feed_messages(test::synthetic_drive(test::noisy_drive(60.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        add(channel, bytes);
                        if (channel == Channel::kGnssEpoch && ++epochs == kHeldEpoch) {
                          add(Channel::kCommand, encoder.encode(Command(), test::kSkyEpoch, 1));
                        }
                      });
  return list;
}

// The filter gets to the held epoch only when the inertial stage has done everything received up to
// and with the restart.
Collector run_held(const std::vector<Input>& list, const std::string& journal) {
  std::atomic<bool> released{false};
  EngineHooks hooks;
  hooks.before_epoch = [&](std::uint64_t epoch) {
    while (epoch == kHeldEpoch && !released) test::wait_a_moment();
  };
  DaemonConfig config = test::drive_config();
  config.journal.path = journal;
  Collector outputs;
  Engine engine(config, &outputs, hooks);
  engine.start();
  std::int64_t stamp = 0;
  std::uint64_t epochs = 0;
  for (const Input& input : list) {
    engine.receive(input.channel, input.bytes, ++stamp);
    if (input.channel == Channel::kGnssEpoch) ++epochs;
    if (input.channel == Channel::kCommand) {
      while (!engine.idle_but_gnss()) test::wait_a_moment();
      CHECK(engine.counters().source.get() == static_cast<std::int64_t>(Source::kNone));
      released = true;
    }
    const bool held = epochs == kHeldEpoch && !released;
    while (!(held ? engine.idle_but_gnss() : engine.idle())) test::wait_a_moment();
  }
  released = true;
  CHECK(engine.finish());
  CHECK(engine.counters().source.get() == static_cast<std::int64_t>(Source::kEkf));
  return outputs;
}

}  // namespace

TEST_CASE("a restart behind an epoch under way: live, Navigator and replay answer alike") {
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("journal.lcmlog");
  const std::vector<Input> list = drive_with_restart();
  const Collector live = run_held(list, journal);
  CHECK(test::missed_epochs(live).empty());
  CHECK(live.groups[1].size() == 59);
  test::check_same(test::run_navigator(list, {}), live);
  test::check_same(test::run_navigator(test::read_journal_inputs(journal), {}), live);

  // Whole seconds are those of the epochs; the restart came with the held one, behind the
  // IMU sample of 65 ms after.
  const std::int64_t restart_ns =
      test::kSkyEpoch.plus_seconds(static_cast<double>(kHeldEpoch) + 0.066).nanoseconds();
  int after = 0, aligning = 0;
  for (const test::Bytes& bytes : live.groups[0]) {
    solution_t solution{};
    const int size = static_cast<int>(bytes.size());
    REQUIRE(solution.decode(bytes.data(), 0, size) == size);
    if (solution.time_ns <= restart_ns) continue;
    if (++after == 1) CHECK(solution.source == static_cast<int>(Source::kAligning));
    if (solution.source == static_cast<int>(Source::kAligning)) ++aligning;
    CHECK(solution.anchor_epoch > static_cast<std::int64_t>(kHeldEpoch));
  }
  CHECK(after > 3'000);
  CHECK(aligning > 100);
}
