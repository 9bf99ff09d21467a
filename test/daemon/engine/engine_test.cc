// The threaded engine against Navigator on one input: the same bytes, misses included.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <thread>
#include <vector>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Bytes;
using test::check_same;
using test::Collector;
using test::Input;
using test::missed_epochs;
using test::read_journal_inputs;
using test::run_navigator;

// A drive with an outage of two seconds, and now and then a message that is damaged.
const std::vector<Input>& inputs() {
  static const std::vector<Input> list = [] {
    int epochs = 0;
    const std::vector<Input> whole = test::drive_messages([&](Channel channel) {
      return channel != Channel::kGnssEpoch || (++epochs != 30 && epochs != 31);
    });
    std::vector<Input> made;
    for (const Input& input : whole) {
      made.push_back(input);
      if (made.size() % 997 != 0) continue;
      made.push_back(made.back());
      made.back().bytes.resize(made.back().bytes.size() / 2);
    }
    made.push_back({Channel::kImu, Bytes(100'000, 0x55)});
    return made;
  }();
  return list;
}

enum class Pace { kFlatOut, kStepByStep };

Collector run_engine(Pace pace, const std::string& journal) {
  DaemonConfig config = test::drive_config();
  config.journal.path = journal;
  Collector outputs;
  Engine engine(config, &outputs);
  engine.start();
  std::int64_t stamp = 0;
  for (const Input& input : inputs()) {
    engine.receive(input.channel, input.bytes, ++stamp);
    // Around an epoch the result must be in before the next sample asks for it.
    while (pace == Pace::kStepByStep && !engine.idle()) test::wait_a_moment();
  }
  REQUIRE(engine.finish());
  return outputs;
}

}  // namespace

TEST_CASE("threads in step give the bytes of the single thread, without a miss") {
  const test::TemporaryFile folder("unused", "");
  const Collector threaded = run_engine(Pace::kStepByStep, "");
  CHECK(missed_epochs(threaded).empty());
  check_same(run_navigator(inputs(), {}), threaded);
  CHECK(threaded.groups[0].size() > 10'000);
  CHECK(threaded.groups[2].size() > 50);
  CHECK(threaded.groups[3].size() > 5);  // the damaged messages
}

TEST_CASE("flat out, with whatever misses that gives, the journal gives the same bytes") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal.lcmlog");
  const Collector threaded = run_engine(Pace::kFlatOut, path);
  const auto missed = missed_epochs(threaded);
  std::cout << "flat out: " << missed.size() << " of " << threaded.groups[1].size()
            << " epochs missed\n";
  const std::vector<Input> journaled = read_journal_inputs(path);
  // What was refused is counted.
  const auto in = [](Channel channel) {
    return [channel](const Input& input) { return input.channel == channel; };
  };
  const auto count = [](const std::vector<Input>& list, auto what) {
    return std::count_if(list.begin(), list.end(), what);
  };
  CHECK(count(journaled, in(Channel::kRefused)) >= 5);
  CHECK(count(journaled, in(Channel::kImu)) < count(inputs(), in(Channel::kImu)));
  const Collector first = run_navigator(journaled, missed);
  check_same(first, threaded);
  for (int i = 0; i < 9; ++i) check_same(run_navigator(journaled, missed), first);
}

TEST_CASE("a journal on a full disk is reported, and costs no output") {
  if (!std::filesystem::exists("/dev/full")) return;
  const Collector reference = run_navigator(inputs(), {});
  DaemonConfig config = test::drive_config();
  config.journal.path = "/dev/full";
  Collector outputs;
  Engine engine(config, &outputs);
  engine.start();
  for (const Input& input : inputs()) {
    engine.receive(input.channel, input.bytes, 1);
    while (!engine.idle()) test::wait_a_moment();  // without misses, as the reference
  }
  CHECK_FALSE(engine.finish());
  CHECK(engine.journal().error().find("/dev/full: cannot be written") == 0);
  CHECK(outputs.groups[0].size() == reference.groups[0].size());
}
