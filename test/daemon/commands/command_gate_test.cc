// Who is let through with a command, how often and how long; and what the journal of such a run
// has.
#include "daemon/commands/command_gate.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "command_keys.h"
#include "drivers/lcm/encode.h"
#include "support/catch.h"
#include "tools/common/allocations/allocation_counter.h"

namespace {

using namespace leonav;
using test::kKey;
using test::kOtherKey;
using test::kSecond;

using Message = std::array<std::uint8_t, kSignedCommandBytes>;

Message sign(const CommandNonce& nonce, const CommandKey& key = kKey,
             const Command& command = Command()) {
  Encoder encoder;
  SignedCommand made;
  made.nonce = nonce;
  const ByteSpan bytes = encoder.encode(command, GpsTime(), 9);
  REQUIRE(bytes.size() == made.command.size());
  std::copy(bytes.begin(), bytes.end(), made.command.begin());
  made.mac = key.mac_of(made.nonce, made.command);
  return encode_signed_command(made);
}

// What the gate publishes now, which must be due.
CommandNonce published(CommandGate* gate, std::int64_t now_ns) {
  const auto message = gate->due_nonce(now_ns);
  REQUIRE(message.has_value());
  const auto nonce = decode_command_nonce(*message);
  REQUIRE(nonce.has_value());
  return *nonce;
}

}  // namespace

TEST_CASE("another key is the only one from then on, also for numbers that are out", "[commands]") {
  CommandGate gate(kKey);
  const CommandNonce nonce = published(&gate, 0);
  gate.set_key(kOtherKey);
  CHECK(gate.judge(sign(nonce, kKey), kSecond) == InputFault::kUnauthenticated);
  CHECK(gate.judge(sign(nonce, kOtherKey), kSecond) == InputFault::kNone);
}

TEST_CASE("the key may be set by one thread while another one judges", "[commands]") {
  CommandGate gate(kKey);
  std::atomic<bool> done = false;
  std::thread setter([&] {
    for (int i = 0; i < 2000; ++i) gate.set_key(i % 2 == 0 ? kOtherKey : kKey);
    done = true;
  });
  const Message junk{};
  while (!done) CHECK(gate.judge(junk, 0) != InputFault::kNone);
  setter.join();
  CHECK(gate.judge(sign(published(&gate, 0)), 0) == InputFault::kNone);  // the last one was kKey
}

TEST_CASE("a command with the right key is let through as it is, and once", "[commands]") {
  CommandGate gate(kKey);
  const Message message = sign(published(&gate, 0));
  REQUIRE(gate.judge(message, kSecond) == InputFault::kNone);
  Decoder decoder;
  Command command;
  CHECK(decoder.decode(gate.command(), &command).fault == InputFault::kNone);
  CHECK(command.kind == CommandKind::kRestart);
  CHECK(command.sequence == 9);

  CHECK(gate.judge(message, kSecond) == InputFault::kUnauthenticated);  // replayed
  // The next number is there at once, and serves.
  const CommandNonce next = published(&gate, kSecond);
  CHECK(gate.judge(sign(next), kSecond) == InputFault::kNone);
}

TEST_CASE("a wrong key, a wrong number and junk are refused, and spoil nothing", "[commands]") {
  CommandGate gate(kKey);
  const CommandNonce nonce = published(&gate, 0);
  CHECK(gate.judge(sign(nonce, kOtherKey), 0) == InputFault::kUnauthenticated);
  CHECK(gate.judge(sign(CommandNonce{}), 0) == InputFault::kUnauthenticated);
  Message changed = sign(nonce);
  changed[8 + 8 + 8 + 4 + 16 + 30] ^= 1;  // a restart becomes another command
  CHECK(gate.judge(changed, 0) == InputFault::kUnauthenticated);
  const std::vector<std::uint8_t> junk(kSignedCommandBytes, 0x55);
  CHECK(gate.judge(junk, 0) == InputFault::kUndecodable);
  CHECK(gate.judge({}, 0) == InputFault::kUndecodable);
  Encoder encoder;
  CHECK(gate.judge(encoder.encode(Command(), GpsTime(), 1), 0) == InputFault::kUndecodable);
  CHECK(gate.judge(sign(nonce), 0) == InputFault::kNone);
}

TEST_CASE("a number serves for ten seconds at least and for twenty at most", "[commands]") {
  for (const std::int64_t published_s : {0, 9}) {
    for (const auto& [after_s, is_good] : {std::pair(1, true), {11, true}, {21, false}}) {
      INFO(published_s << " s, used " << after_s << " s later");
      CommandGate gate(kKey);
      CommandNonce nonce{};
      std::int64_t now_s = 0;
      for (; now_s <= published_s; ++now_s) nonce = published(&gate, now_s * kSecond);
      for (; now_s < published_s + after_s; ++now_s) gate.due_nonce(now_s * kSecond);
      const bool expected = is_good && published_s + after_s < 20;
      CHECK((gate.judge(sign(nonce), now_s * kSecond) == InputFault::kNone) == expected);
    }
  }
  // A gate that was held up itself forgets the number all the same.
  CommandGate gate(kKey);
  const CommandNonce nonce = published(&gate, 0);
  CHECK(gate.judge(sign(nonce), 20 * kSecond) == InputFault::kUnauthenticated);
}

TEST_CASE("a command of an earlier run of leonavd is refused", "[commands]") {
  CommandGate before(kKey);
  const Message message = sign(published(&before, 0));
  CommandGate after(kKey);
  published(&after, 0);
  CHECK(after.judge(message, 0) == InputFault::kUnauthenticated);
  CHECK(before.judge(message, 0) == InputFault::kNone);
}

TEST_CASE("the number is published each second and changes each ten", "[commands]") {
  CommandGate gate(kKey);
  std::vector<CommandNonce> numbers;
  for (int tenths = 0; tenths < 300; ++tenths) {
    const auto message = gate.due_nonce(tenths * kSecond / 10);
    CHECK(message.has_value() == (tenths % 10 == 0));
    if (message) numbers.push_back(*decode_command_nonce(*message));
  }
  REQUIRE(numbers.size() == 30);
  for (std::size_t i = 1; i < numbers.size(); ++i)
    CHECK((numbers[i] == numbers[i - 1]) == (i % 10 != 0));
}

TEST_CASE("the gate allocates nothing", "[commands]") {
  CommandGate gate(kKey);
  const CommandNonce nonce = published(&gate, 0);
  const Message good = sign(nonce), wrong = sign(nonce, kOtherKey);
  const std::vector<std::uint8_t> junk(100, 0x55);
  start_counting_allocations();
  std::size_t refused = 0, taken = 0;
  for (int i = 0; i < 1000; ++i) {
    gate.due_nonce(i * kSecond / 200);
    refused += gate.judge(wrong, i * kSecond / 200) == InputFault::kUnauthenticated ? 1 : 0;
    refused += gate.judge(junk, i * kSecond / 200) == InputFault::kUndecodable ? 1 : 0;
  }
  taken += gate.judge(good, 6 * kSecond) == InputFault::kNone ? 1 : 0;
  gate.due_nonce(100 * kSecond);
  CHECK(stop_counting_allocations() == 0);
  CHECK(refused == 2000);
  CHECK(taken == 1);
}
