// Changed tells when a value becomes another one, so that the log has it once.
#pragma once

namespace leonav {

template <typename T>
class Changed {
 public:
  // Whether `value` is another one than at the last look, or at the first look than T().
  bool look(const T& value) {
    if (value == last_) return false;
    last_ = value;
    return true;
  }

 private:
  T last_{};
};

}  // namespace leonav
