#include "tools/serve/output_queue.h"

#include <utility>

#include "drivers/nmea/sentence.h"

namespace leonav {

bool OutputQueue::offer(const std::shared_ptr<const Batch>& batch) {
  if (bytes_ + batch->text.size() > kMostBytes) {
    lost_ += static_cast<std::uint64_t>(batch->sentences);
    untold_ += static_cast<std::uint64_t>(batch->sentences);
    return false;
  }
  if (untold_ > 0) {
    push(std::make_shared<const std::string>(
        text_sentence(std::to_string(untold_) + " sentences lost: the reader is too slow")));
    untold_ = 0;
  }
  push({batch, &batch->text});
  return true;
}

void OutputQueue::push(std::shared_ptr<const std::string> text) {
  bytes_ += text->size();
  texts_.push_back(std::move(text));
}

void OutputQueue::consume(std::size_t bytes) {
  offset_ += bytes;
  while (!texts_.empty() && offset_ >= texts_.front()->size()) {
    offset_ -= texts_.front()->size();
    bytes_ -= texts_.front()->size();
    texts_.pop_front();
  }
}

void OutputQueue::clear() {
  texts_.clear();
  bytes_ = offset_ = 0;
  untold_ = 0;
}

}  // namespace leonav
