// The CommandGate lets a command through only where it is signed with the key, and only once.
//
// A signed command carries a nonce, a random number that the gate has published. A nonce serves for
// one command, and for kRenewal_ns to twice as long; a gate never publishes one again, nor does the
// next run. Therefore no clock has to be right, and neither leonavd nor a sender has to remember
// anything over a restart.
#pragma once
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

#include "core/base/gps_time.h"
#include "daemon/commands/command_key.h"

namespace leonav {

// One thread, but for set_key(). Allocates nothing after construction.
class CommandGate {
 public:
  static constexpr std::int64_t kRenewal_ns = 10 * kNanosecondsPerSecond;
  static constexpr std::int64_t kPublishing_ns = kNanosecondsPerSecond;

  // Throws std::system_error where the system has no random numbers. Once it has, it has some for
  // each renewal.
  explicit CommandGate(CommandKey key);

  // The message COMMAND_NONCE where it is due: each second, and after each command let through.
  // `now_ns`: of a clock that never goes back.
  std::optional<std::span<const std::uint8_t>> due_nonce(std::int64_t now_ns) noexcept;

  // Looks at a message signed_command_t. kNone: command() is to be received as COMMAND.
  InputFault judge(std::span<const std::uint8_t> message, std::int64_t now_ns) noexcept;
  // An encoded command_t, of which the gate knows nothing but who has signed it.
  std::span<const std::uint8_t> command() const { return received_.command; }

  // Any thread: this key is the only one from the next command on. The other thread never waits for
  // this one: a command that it looks at meanwhile is still judged by the key before.
  void set_key(CommandKey key);

 private:
  void take_key() noexcept;
  void renew(std::int64_t now_ns) noexcept;
  bool is_valid(const CommandNonce& nonce) const;

  CommandKey key_;
  std::mutex next_key_mutex_;
  std::optional<CommandKey> next_key_;
  CommandNonce current_{};
  std::optional<CommandNonce> previous_;
  std::optional<std::int64_t> renewed_ns_, published_ns_;
  std::uint64_t sequence_ = 0;
  std::array<std::uint8_t, kCommandNonceBytes> message_{};
  SignedCommand received_;
};

}  // namespace leonav
