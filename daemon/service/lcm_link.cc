#include "daemon/service/lcm_link.h"

#include "daemon/threads/process_threads.h"

namespace leonav {

LcmReceiver::LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine)
    : engine_(engine), prefix_(config.prefix) {
  const std::set<pid_t> before = threads_of_process();
  lcm_ = open_lcm(config.url);
  for (const Channel channel : kInputChannels) {
    const std::string name = channel_name(channel, prefix_);
    lcm::Subscription* subscription = lcm_->subscribe(name, &LcmReceiver::on_message, this);
    if (subscription == nullptr) {
      throw LcmError("LCM cannot subscribe to " + name + " at '" + config.url + "'");
    }
    subscription->setQueueCapacity(config.receive_queue);
  }
  for (const pid_t thread : threads_of_process()) {
    if (!before.contains(thread) && refused_.empty()) refused_ = set_priority(thread, "of LCM", io);
  }
}

bool LcmReceiver::receive(int timeout_ms) { return lcm_->handleTimeout(timeout_ms) >= 0; }

void LcmReceiver::on_message(const lcm::ReceiveBuffer* buffer, const std::string& name) {
  const auto channel = channel_from_name(name, prefix_);
  if (!channel) return;
  engine_->receive(*channel, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size},
                   buffer->recv_utime);
}

}  // namespace leonav
