#include "daemon/commands/command_gate.h"

#include <utility>

#include "daemon/commands/random_bytes.h"

namespace leonav {
namespace {

CommandNonce random_nonce() {
  CommandNonce nonce;
  fill_random(nonce);
  return nonce;
}

}  // namespace

CommandGate::CommandGate(CommandKey key) : key_(std::move(key)), current_(random_nonce()) {}

std::optional<std::span<const std::uint8_t>> CommandGate::due_nonce(std::int64_t now_ns) noexcept {
  renew(now_ns);
  if (published_ns_ && now_ns - *published_ns_ < kPublishing_ns) return std::nullopt;
  published_ns_ = now_ns;
  message_ = encode_command_nonce(current_, ++sequence_);
  return message_;
}

InputFault CommandGate::judge(std::span<const std::uint8_t> message, std::int64_t now_ns) noexcept {
  take_key();
  renew(now_ns);
  const InputFault fault = decode_signed_command(message, &received_);
  if (fault != InputFault::kNone) return fault;
  // The nonce first: it costs nothing, however many wrong commands come.
  if (!is_valid(received_.nonce) || !key_.has_signed(received_))
    return InputFault::kUnauthenticated;
  current_ = random_nonce();
  previous_.reset();
  renewed_ns_ = now_ns;
  published_ns_.reset();
  return InputFault::kNone;
}

void CommandGate::set_key(CommandKey key) {
  const std::lock_guard lock(next_key_mutex_);
  next_key_ = std::move(key);
}

void CommandGate::take_key() noexcept {
  const std::unique_lock lock(next_key_mutex_, std::try_to_lock);
  if (!lock || !next_key_) return;
  key_ = std::move(*next_key_);
  next_key_.reset();
}

// The nonce before is still good, for senders that have it already.
void CommandGate::renew(std::int64_t now_ns) noexcept {
  if (!renewed_ns_) renewed_ns_ = now_ns;
  const std::int64_t age_ns = now_ns - *renewed_ns_;
  if (age_ns < kRenewal_ns) return;
  if (age_ns < 2 * kRenewal_ns)
    previous_ = current_;
  else
    previous_.reset();
  current_ = random_nonce();
  renewed_ns_ = now_ns;
  published_ns_.reset();
}

bool CommandGate::is_valid(const CommandNonce& nonce) const {
  return nonce == current_ || nonce == previous_;
}

}  // namespace leonav
