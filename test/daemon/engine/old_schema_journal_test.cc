// A journal whose outputs are of the first schema, without protection levels, still verifies.
#include <string>
#include <vector>

#include "core/navigator/navigator.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/messages/encoding_sink.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/has.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;
using test::has;

// Writes what it is given to a log.
struct LogTarget final : MessageTarget {
  explicit LogTarget(const std::string& path) : log(path) {}
  void take(Channel channel, ByteSpan bytes) override {
    REQUIRE(log.write(1, channel_name(channel), bytes));
  }
  EventLogWriter log;
};

// Writes a drive's journal as a program of `schema` would have.
void write_journal(const std::string& path, OutputSchema schema,
                   const std::vector<std::string>& overrides) {
  const DaemonConfig config = load_preset("phone_imu", overrides);
  LogTarget target(path);
  target.take(Channel::kConfig, encode(RunConfiguration{
                                    "leonavd 0.1.0", "a.yaml", effective_text(config.source), {}}));
  EncodingSink sink(&target, schema);
  Navigator navigator(config.navigator, &sink);
  InputDispatch dispatch(&navigator.sequencer());
  test::feed_messages(test::synthetic_drive(test::noisy_drive(15.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        target.take(channel, bytes);
                        dispatch.dispatch(channel, bytes);
                      });
  target.take(Channel::kEnd, encode_journal_end(target.log.events()));
  REQUIRE(target.log.flush());
}

test::ProgramRun verify(const std::string& journal, const test::TemporaryFile& folder) {
  return test::run_program("leonav-replay",
                           "--verify --out '" + folder.beside("replay") + "' '" + journal + "'");
}

// Copies a journal with the last bit of the `which`-th message of a channel turned over.
void spoil(const std::string& from, const std::string& to, Channel channel, int which) {
  EventLogReader log(from);
  EventLogWriter copy(to);
  for (LogEvent event; log.next(&event);) {
    if (event.channel == channel_name(channel) && which-- == 0) event.data.back() ^= 1;
    REQUIRE(copy.write(event.timestamp_us, event.channel, event.data));
  }
  REQUIRE(copy.flush());
}

}  // namespace

TEST_CASE("journals of either schema verify, and a single bit that differs is found") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("journal.lcmlog"), spoilt = folder.beside("spoilt");
  for (const OutputSchema schema : {OutputSchema::kFirst, OutputSchema::kNewest}) {
    write_journal(journal, schema, {});
    const auto right = verify(journal, folder);
    INFO(right.err);
    CHECK(right.exit_code == 0);
    CHECK(has(right.out, " 0 differences"));
    CHECK(has(right.out, "outputs in schema 1") == (schema == OutputSchema::kFirst));
    for (const Channel channel : {Channel::kSolution, Channel::kEpoch}) {
      spoil(journal, spoilt, channel, 3);
      const auto wrong = verify(spoilt, folder);
      CHECK(wrong.exit_code == 1);
      CHECK(has(wrong.out, ", 1 differences"));
    }
  }
}

TEST_CASE("the smoother's answers of the first schema verify, with the iterations of then") {
  if (!test::have_programs("leonav-replay")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string journal = folder.beside("journal.lcmlog");
  write_journal(journal, OutputSchema::kFirst, {"estimator=smoother", "smoother.window=5"});
  const auto run = verify(journal, folder);
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(has(run.out, " 0 differences"));
  CHECK_FALSE(has(run.out, "output SMOOTHER: 0"));
}
