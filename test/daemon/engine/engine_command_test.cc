// Signed commands in a running engine: the journal has those that were taken, and replays without
// the key.
#include <algorithm>
#include <thread>
#include <vector>

#include "commands/command_keys.h"
#include "daemon/commands/command_gate.h"
#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::kKey;
using test::kOtherKey;
using test::kSecond;

using Message = std::array<std::uint8_t, kSignedCommandBytes>;

Message restart_signed(const CommandNonce& nonce, const CommandKey& key) {
  Encoder encoder;
  SignedCommand made;
  made.nonce = nonce;
  const ByteSpan bytes = encoder.encode(Command(), GpsTime(), 9);
  REQUIRE(bytes.size() == made.command.size());
  std::copy(bytes.begin(), bytes.end(), made.command.begin());
  made.mac = key.mac_of(made.nonce, made.command);
  return encode_signed_command(made);
}

}  // namespace

TEST_CASE("the journal of a run with a key replays without it", "[commands]") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("journal.lcmlog");
  test::Collector live;
  Engine engine(config, &live);
  engine.start();
  CommandGate gate(kKey);
  Message taken{};
  std::int64_t epochs = 0;
  const auto send = [&](const Message& message) {
    const InputFault fault = gate.judge(message, epochs * kSecond);
    if (fault == InputFault::kNone)
      engine.receive(Channel::kCommand, gate.command(), 1);
    else
      engine.refuse(Channel::kCommand, fault, 1);
  };
  test::feed_messages(test::synthetic_drive(test::noisy_drive(60.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        engine.receive(channel, bytes, 1);
                        if (channel != Channel::kGnssEpoch) return;
                        ++epochs;
                        if (const auto nonce = gate.due_nonce(epochs * kSecond)) {
                          engine.publish_from_io(Channel::kCommandNonce, *nonce, 1);
                          if (epochs == 20)
                            send(restart_signed(*decode_command_nonce(*nonce), kOtherKey));
                          if (epochs == 40) {
                            taken = restart_signed(*decode_command_nonce(*nonce), kKey);
                            send(taken);
                            send(taken);
                          }
                        }
                        while (!engine.idle()) test::wait_a_moment();
                      });
  REQUIRE(engine.finish());
  const std::size_t command = index_of(Channel::kCommand);
  CHECK(engine.counters().received[command].get() == 3);
  CHECK(engine.counters().refused[command].get() == 2);
  const auto fault = static_cast<std::size_t>(InputFault::kUnauthenticated);
  CHECK(engine.counters().rejected[fault].get() == 2);

  const std::vector<test::Input> inputs = test::read_journal_inputs(config.journal.path);
  CHECK(std::count_if(inputs.begin(), inputs.end(), [](const test::Input& input) {
          return input.channel == Channel::kCommand;
        }) == 1);
  test::check_same(test::run_navigator(inputs, test::missed_epochs(live)), live);
}
