#include "daemon/service/lcm_link.h"

#include "daemon/threads/process_threads.h"

namespace leonav {

LcmReceiver::LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine)
    : engine_(engine), prefix_(config.prefix) {
  const std::set<pid_t> before = threads_of_process();
  lcm_ = open_lcm(config.url);
  for (const Channel channel : kInputChannels) {
    const std::string name = channel_name(channel, prefix_);
    // The C++ interface would allocate the channel's name for each message, and crash where liblcm
    // cannot start its thread, which it does with the first subscription.
    lcm_subscription_t* subscription =
        lcm_subscribe(lcm_->getUnderlyingLCM(), name.c_str(), &LcmReceiver::on_message, this);
    if (subscription == nullptr)
      throw LcmError("LCM at '" + config.url +
                     "' starts no thread that receives; see the message above; give it more memory "
                     "or threads (MemoryMax= and TasksMax= of its unit, ulimit -v and -u)");
    lcm_subscription_set_queue_capacity(subscription, config.receive_queue);
  }
  for (const pid_t thread : threads_of_process()) {
    if (!before.contains(thread) && refused_.empty()) refused_ = set_priority(thread, "of LCM", io);
  }
}

bool LcmReceiver::receive(int timeout_ms) { return lcm_->handleTimeout(timeout_ms) >= 0; }

void LcmReceiver::on_message(const lcm_recv_buf_t* buffer, const char* name, void* self) {
  const auto* receiver = static_cast<const LcmReceiver*>(self);
  const auto channel = channel_from_name(name, receiver->prefix_);
  if (!channel) return;
  receiver->engine_->receive(*channel,
                             {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
                             buffer->recv_utime);
}

}  // namespace leonav
