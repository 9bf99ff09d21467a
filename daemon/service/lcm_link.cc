#include "daemon/service/lcm_link.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "daemon/config/lcm_url.h"
#include "daemon/link/message_limit.h"
#include "daemon/threads/process_threads.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/message_sizes.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

// Messages of a channel that wait for `io` take no more memory than this, whatever is sent. At the
// start a sender may send all orbits, or all antenna models, at once.
constexpr std::uint32_t kQueueBytes = 16 * 1024 * 1024;

ByteSpan bytes_of(const lcm_recv_buf_t* buffer) {
  return {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
}

}  // namespace

LcmReceiver::LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine,
                         CommandGate* gate)
    : engine_(engine), gate_(gate), prefix_(config.prefix) {
  // A checkpoint comes from the file alone: who could send one could set the heading.
  std::vector<Input> inputs;
  for (const Channel channel : kInputChannels)
    if (channel != Channel::kCheckpoint)
      inputs.push_back({channel_name(channel, prefix_), most_message_bytes(channel), &on_message});
  if (gate_) {
    inputs.push_back({prefix_ + std::string(kSignedCommandChannel), wire::kMaxBytesWithoutList,
                      &on_signed_command});
  }
  const std::set<pid_t> before = threads_of_process();
  const MessageLimit limit;
  lcm_ = open_lcm(config.url);
  if (udpm_address(config.url)) {
    // liblcm opens its sockets with the first subscription: to a channel that nobody sends on, so
    // that no message is taken before the limit holds.
    lcm_subscription_t* first =
        subscribe(config, {prefix_ + "LIMIT", wire::kMaxBytesWithoutList, &on_nothing});
    std::vector<ReceivedChannel> channels;
    for (const Input& input : inputs) channels.push_back({input.channel, input.most_bytes});
    refused_ = limit.apply(channels);
    lcm_unsubscribe(lcm_->getUnderlyingLCM(), first);
  }
  for (const Input& input : inputs) subscribe(config, input);
  for (const pid_t thread : threads_of_process()) {
    if (!before.contains(thread) && refused_.empty()) refused_ = schedule(thread, "of LCM", io);
  }
}

lcm_subscription_t* LcmReceiver::subscribe(const LcmConfig& config, const Input& input) {
  // The C++ interface would allocate the channel's name for each message, and crash where liblcm
  // cannot start its thread, which it does with the first subscription.
  lcm_subscription_t* subscription =
      lcm_subscribe(lcm_->getUnderlyingLCM(), input.channel.c_str(), input.handler, this);
  if (subscription == nullptr)
    throw LcmError("LCM at '" + config.url +
                   "' starts no thread that receives; see the message above; give it more memory "
                   "or threads (MemoryMax= and TasksMax= of its unit, ulimit -v and -u)");
  lcm_subscription_set_queue_capacity(
      subscription,
      std::min(config.receive_queue, static_cast<int>(kQueueBytes / input.most_bytes)));
  return subscription;
}

bool LcmReceiver::receive(int timeout_ms) {
  if (gate_) {
    if (const auto nonce = gate_->due_nonce(monotonic_ns()))
      engine_->publish_from_io(Channel::kCommandNonce, *nonce, wall_clock_us());
  }
  return lcm_->handleTimeout(timeout_ms) >= 0;
}

void LcmReceiver::on_nothing(const lcm_recv_buf_t*, const char*, void*) {}

void LcmReceiver::on_message(const lcm_recv_buf_t* buffer, const char* name, void* self) {
  const auto* receiver = static_cast<const LcmReceiver*>(self);
  const auto channel = channel_from_name(name, receiver->prefix_);
  if (!channel) return;
  if (*channel == Channel::kCommand && receiver->gate_)
    return receiver->engine_->refuse(*channel, InputFault::kUnauthenticated, buffer->recv_utime);
  receiver->engine_->receive(*channel, bytes_of(buffer), buffer->recv_utime);
}

void LcmReceiver::on_signed_command(const lcm_recv_buf_t* buffer, const char*, void* self) {
  auto* receiver = static_cast<LcmReceiver*>(self);
  CommandGate& gate = *receiver->gate_;
  const InputFault fault = gate.judge(bytes_of(buffer), monotonic_ns());
  if (fault != InputFault::kNone)
    return receiver->engine_->refuse(Channel::kCommand, fault, buffer->recv_utime);
  receiver->engine_->receive(Channel::kCommand, gate.command(), buffer->recv_utime);
}

}  // namespace leonav
