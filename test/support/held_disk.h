// A disk that answers nobody until it is told to.
#pragma once
#include <future>

namespace leonav::test {

class HeldDisk {
 public:
  // In the thread that reads or writes; may outlive the test.
  void wait() const { answers_.wait(); }
  void answer() { answer_.set_value(); }

 private:
  std::promise<void> answer_;
  std::shared_future<void> answers_ = answer_.get_future().share();
};

}  // namespace leonav::test
