#include "daemon/service/lcm_link.h"

#include "daemon/threads/process_threads.h"

namespace leonav {
namespace {

// liblcm starts its thread with the first subscription. Where that fails, its C++ class gives a
// subscription that crashes at the first use.
void require_subscriptions(lcm::LCM* lcm, const std::string& url) {
  const auto ignore = [](const lcm_recv_buf_t*, const char*, void*) {};
  lcm_subscription_t* probe =
      lcm_subscribe(lcm->getUnderlyingLCM(), "LEONAV_NOBODY", ignore, nullptr);
  if (probe == nullptr)
    throw LcmError("LCM at '" + url +
                   "' starts no thread that receives; see the message above (is the memory of the "
                   "process limited?)");
  lcm_unsubscribe(lcm->getUnderlyingLCM(), probe);
}

}  // namespace

LcmReceiver::LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine)
    : engine_(engine), prefix_(config.prefix) {
  const std::set<pid_t> before = threads_of_process();
  lcm_ = open_lcm(config.url);
  require_subscriptions(lcm_.get(), config.url);
  for (const Channel channel : kInputChannels) {
    const std::string name = channel_name(channel, prefix_);
    lcm_->subscribe(name, &LcmReceiver::on_message, this)->setQueueCapacity(config.receive_queue);
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
