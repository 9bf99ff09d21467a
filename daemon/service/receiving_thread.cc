#include "daemon/service/receiving_thread.h"

namespace leonav {
namespace {

constexpr int kLongestWait_ms = 100;  // until a stop is seen

}  // namespace

std::string ReceivingThread::start(const ThreadConfig& config) {
  return thread_.start("io", config, [this] { receive(); });
}

void ReceivingThread::stop() {
  stop_.store(true);
  thread_.join();
}

void ReceivingThread::receive() {
  while (!stop_.load()) {
    engine_->counters().io_rounds.add(1);
    if (!receiver_->receive(kLongestWait_ms)) {
      failed_.store(true);
      return;
    }
  }
}

}  // namespace leonav
