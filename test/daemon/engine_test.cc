// The threaded engine against Pipeline on one input: the same bytes, misses included.
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <thread>
#include <vector>

#include "core/navigator/pipeline.h"
#include "daemon/engine.h"
#include "daemon/input_dispatch.h"
#include "daemon/output_groups.h"
#include "drive_inputs.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;
using Bytes = std::vector<std::uint8_t>;

using test::Input;

// A drive with an outage of two seconds, and now and then a message that is damaged.
const std::vector<Input>& inputs() {
  static const std::vector<Input> list = [] {
    std::vector<Input> made;
    int epochs = 0;
    test::feed_messages(test::synthetic_drive(test::noisy_drive(60.0)),
                        [&](Channel channel, ByteSpan bytes) {
                          if (channel == Channel::kGnssEpoch && (++epochs == 30 || epochs == 31)) {
                            return;
                          }
                          made.push_back({channel, Bytes(bytes.begin(), bytes.end())});
                          if (made.size() % 997 == 0) {
                            made.push_back(made.back());
                            made.back().bytes.resize(made.back().bytes.size() / 2);
                          }
                        });
    made.push_back({Channel::kImu, Bytes(100'000, 0x55)});
    return made;
  }();
  return list;
}

struct Collector final : MessageTarget {
  std::array<std::vector<Bytes>, kOutputGroups.size()> groups;
  void take(Channel channel, ByteSpan bytes) override {
    if (const auto group = output_group(channel, bytes)) {
      groups[*group].emplace_back(bytes.begin(), bytes.end());
    }
  }
};

std::vector<std::uint64_t> missed_epochs(const Collector& outputs) {
  Decoder decoder;
  std::vector<std::uint64_t> missed;
  for (const Bytes& bytes : outputs.groups[1]) {
    Decision decision;
    REQUIRE(decoder.decode(bytes, &decision).fault == InputFault::kNone);
    if (!decision.committed) missed.push_back(decision.epoch);
  }
  return missed;
}

Collector run_pipeline(const std::vector<Input>& list, const std::vector<std::uint64_t>& missed) {
  Collector outputs;
  EncodingSink sink(&outputs);
  Pipeline pipeline(test::drive_config().navigator, &sink);
  for (const std::uint64_t epoch : missed) pipeline.record_miss(epoch);
  InputDispatch dispatch(&pipeline.sequencer());
  for (const Input& input : list) dispatch.dispatch(input.channel, input.bytes);
  return outputs;
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
    while (pace == Pace::kStepByStep && !engine.idle()) std::this_thread::yield();
  }
  REQUIRE(engine.finish());
  return outputs;
}

std::vector<Input> read_journal_inputs(const std::string& path) {
  EventLogReader log(path);
  std::vector<Input> list;
  LogEvent event;
  while (log.next(&event)) {
    const auto channel = channel_from_name(event.channel);
    REQUIRE(channel.has_value());
    if (is_input(*channel)) list.push_back({*channel, event.data});
  }
  CHECK_FALSE(log.truncated());
  return list;
}

void check_same(const Collector& a, const Collector& b) {
  for (std::size_t group = 0; group < kOutputGroups.size(); ++group) {
    INFO(kOutputGroups[group]);
    REQUIRE(a.groups[group].size() == b.groups[group].size());
    CHECK(a.groups[group] == b.groups[group]);
  }
}

}  // namespace

TEST_CASE("threads in step give the bytes of the single thread, without a miss") {
  const test::TemporaryFile folder("unused", "");
  const Collector threaded = run_engine(Pace::kStepByStep, "");
  CHECK(missed_epochs(threaded).empty());
  check_same(run_pipeline(inputs(), {}), threaded);
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
  CHECK(journaled.size() == inputs().size());
  const Collector first = run_pipeline(journaled, missed);
  check_same(first, threaded);
  for (int i = 0; i < 9; ++i) check_same(run_pipeline(journaled, missed), first);
}

TEST_CASE("a journal on a full disk is told, and costs no output") {
  if (!std::filesystem::exists("/dev/full")) return;
  const Collector reference = run_pipeline(inputs(), {});
  DaemonConfig config = test::drive_config();
  config.journal.path = "/dev/full";
  Collector outputs;
  Engine engine(config, &outputs);
  engine.start();
  for (const Input& input : inputs()) {
    engine.receive(input.channel, input.bytes, 1);
    while (!engine.idle()) std::this_thread::yield();  // without misses, as the reference
  }
  CHECK_FALSE(engine.finish());
  CHECK(engine.journal_error().find("/dev/full: cannot be written") == 0);
  CHECK(outputs.groups[0].size() == reference.groups[0].size());
}
