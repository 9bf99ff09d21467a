// Refusals counts the inputs that were refused as they came, until the journal is told.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/lcm/journal_marks.h"

namespace leonav {

class Refusals {
 public:
  void add(Channel channel, InputFault fault) {
    const auto index = static_cast<std::size_t>(fault);
    if (index < kInputFaultCount) ++counts_[index][index_of(channel)];
  }

  // Calls use(refused, sequence) for each channel with messages of this fault, and forgets them.
  template <typename Use>
  void take(InputFault fault, Use&& use) {
    const auto index = static_cast<std::size_t>(fault);
    if (index >= kInputFaultCount) return;
    for (const Channel channel : kInputChannels) {
      std::uint64_t& count = counts_[index][index_of(channel)];
      if (count > 0) use(RefusedInputs{channel, fault, count}, ++sequence_);
      count = 0;
    }
  }

 private:
  std::array<std::array<std::uint64_t, kInputChannels.size()>, kInputFaultCount> counts_{};
  std::uint64_t sequence_ = 0;
};

}  // namespace leonav
