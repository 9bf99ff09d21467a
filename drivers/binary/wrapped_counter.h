// The WrappedCounter continues a counter that begins again at zero after its last value.
#pragma once
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace leonav {

// Of all numbers that leave the same rest modulo 2^bits, the one nearest to the number before is
// meant. A counter that stands still, or goes back by less than half of its range, is followed so;
// a pause of more than half of the range cannot be told from a shorter one. Beyond kFarthest, where
// only damaged input leads (139 years of a clock of 1 kHz), it begins anew: so the result times
// 1e6, nanoseconds of such a clock, does not overflow.
class WrappedCounter {
 public:
  // Precondition: 1 <= bits <= 32.
  explicit WrappedCounter(int bits) : range_(std::int64_t{1} << bits) {}

  // Returns the continued number of `value`, of which the bits above the counter's are ignored. The
  // first one is itself.
  std::int64_t extend(std::uint32_t value) {
    const std::int64_t rest = value & (range_ - 1);
    if (!last_ || std::abs(*last_) > kFarthest) {
      last_ = rest;
      return rest;
    }
    std::int64_t step = (rest - *last_) & (range_ - 1);  // 0 to range - 1, also of negative ones
    if (step >= range_ / 2) step -= range_;
    last_ = *last_ + step;
    return *last_;
  }

  static constexpr std::int64_t kFarthest = std::int64_t{1} << 42;

 private:
  std::int64_t range_;
  std::optional<std::int64_t> last_;
};

}  // namespace leonav
