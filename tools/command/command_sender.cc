#include "tools/command/command_sender.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <leonav/event_t.hpp>
#include <stdexcept>
#include <utility>

#include "daemon/commands/random_bytes.h"
#include "daemon/link/open_lcm.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {
namespace {

std::int64_t nanoseconds_of(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

// Random, so that no other sender waits for the same answer; not 0, and exact in the event's
// double.
std::uint64_t random_sequence() {
  std::array<std::uint8_t, sizeof(std::uint64_t)> bytes{};
  fill_random(bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data(), bytes.size());
  return bits >> 12U | 1U;
}

// Whether leonavd may refuse a command for it; other inputs are refused all the time.
bool concerns_commands(InputFault fault) {
  switch (fault) {
    case InputFault::kUnauthenticated:
    case InputFault::kUndecodable:
    case InputFault::kUnknownSchema:
    case InputFault::kNotFinite:
    case InputFault::kOutOfRange:
    case InputFault::kTooOften:
      return true;
    default:
      return false;
  }
}

}  // namespace

CommandSender::CommandSender(const std::string& url, const std::string& prefix,
                             std::optional<CommandKey> key)
    : url_(url), prefix_(prefix), key_(std::move(key)), lcm_(open_lcm(url)) {
  lcm_->subscribe(channel_name(Channel::kCommandNonce, prefix), &CommandSender::on_nonce, this);
  lcm_->subscribe(channel_name(Channel::kEvent, prefix), &CommandSender::on_event, this);
}

CommandResult CommandSender::send(const Command& command, double timeout_s) {
  if (key_) wait_for_nonce(timeout_s);
  sequence_ = random_sequence();
  result_.reset();
  rejected_.reset();
  publish(command);
  const std::int64_t until_ns = monotonic_ns() + nanoseconds_of(timeout_s);
  while (!result_ && monotonic_ns() < until_ns) handle_until(until_ns);
  if (!result_) throw std::runtime_error(why_no_answer());
  return *result_;
}

void CommandSender::wait_for_nonce(double timeout_s) {
  const std::int64_t until_ns = monotonic_ns() + nanoseconds_of(timeout_s);
  while (!nonce_ && monotonic_ns() < until_ns) handle_until(until_ns);
  if (!nonce_)
    throw std::runtime_error("no leonavd that wants signed commands is at '" + url_ +
                             "' with channels " + prefix_ +
                             "*; look whether it runs, at --lcm-url and --prefix, and whether its "
                             "configuration has commands.key_file (without it: no --key-file)");
}

void CommandSender::publish(const Command& command) {
  Encoder encoder;
  const ByteSpan bytes = encoder.encode(command, GpsTime(), sequence_);
  const auto send_as = [&](const std::string& channel, ByteSpan message) {
    if (lcm_->publish(channel, message.data(), static_cast<unsigned>(message.size())) != 0)
      throw std::runtime_error("LCM at '" + url_ + "' does not send; see the message above");
  };
  if (!key_) return send_as(channel_name(Channel::kCommand, prefix_), bytes);
  SignedCommand made;
  made.sequence = sequence_;
  made.nonce = *nonce_;
  std::copy(bytes.begin(), bytes.end(), made.command.begin());
  made.mac = key_->mac_of(made.nonce, made.command);
  send_as(prefix_ + std::string(kSignedCommandChannel), encode_signed_command(made));
}

std::string CommandSender::why_no_answer() const {
  if (!key_ && nonce_)
    return "no answer: this leonavd takes signed commands only; give its key with --key-file";
  std::string text = "no answer";
  if (rejected_)
    text += "; leonavd has meanwhile refused a message as " + std::string(to_string(*rejected_));
  text += key_ ? "; is the key another one, did somebody else send a command at the same time, or "
               : "; does leonavd run at '" + url_ + "' with channels " + prefix_ + "*, or ";
  return text + "were there five commands in ten seconds? Its HEALTH counts what it refuses";
}

void CommandSender::on_nonce(const lcm::ReceiveBuffer* buffer, const std::string&) {
  const auto nonce =
      decode_command_nonce({static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
  if (nonce) nonce_ = nonce;
}

void CommandSender::on_event(const lcm::ReceiveBuffer* buffer, const std::string&) {
  event_t event{};
  const int size = static_cast<int>(buffer->data_size);
  if (event.decode(buffer->data, 0, size) != size || event.schema != 1) return;
  const auto fault = static_cast<InputFault>(event.code);
  if (event.kind == event_t::KIND_REJECTED_INPUT && concerns_commands(fault)) rejected_ = fault;
  if (event.kind == event_t::KIND_COMMAND && event.value == static_cast<double>(sequence_))
    result_ = static_cast<CommandResult>(event.code);
}

// Takes what comes until then, and returns after the first message.
void CommandSender::handle_until(std::int64_t until_ns) {
  const std::int64_t left_ms = (until_ns - monotonic_ns()) / 1'000'000 + 1;
  if (lcm_->handleTimeout(static_cast<int>(std::clamp<std::int64_t>(left_ms, 1, 1000))) < 0)
    throw std::runtime_error("LCM at '" + url_ + "' failed while receiving");
}

}  // namespace leonav
