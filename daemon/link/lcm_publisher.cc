#include "daemon/link/lcm_publisher.h"

namespace leonav {

LcmPublisher::LcmPublisher(const LcmConfig& config)
    : lcm_(open_lcm(config.url)), prefix_(config.prefix) {
  for (std::size_t i = 0; i < kChannelCount; ++i) {
    names_.push_back(channel_name(static_cast<Channel>(i), config.prefix));
  }
}

void LcmPublisher::take(Channel channel, ByteSpan bytes) {
  lcm_->publish(names_[index_of(channel)], bytes.data(), static_cast<unsigned>(bytes.size()));
}

void LcmPublisher::publish(std::string_view name, ByteSpan bytes) {
  lcm_->publish(prefix_ + std::string(name), bytes.data(), static_cast<unsigned>(bytes.size()));
}

}  // namespace leonav
