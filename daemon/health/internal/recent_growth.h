// RecentGrowth is by how much a counter has grown over the last looks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace leonav {

class RecentGrowth {
 public:
  explicit RecentGrowth(std::size_t looks = 10) : values_(looks, 0) {}

  void look(std::int64_t count) {
    growth_ = count - values_[next_];  // the oldest; a counter begins at 0
    values_[next_] = count;
    next_ = (next_ + 1) % values_.size();
  }
  std::int64_t get() const { return growth_; }

 private:
  std::vector<std::int64_t> values_;
  std::size_t next_ = 0;
  std::int64_t growth_ = 0;
};

}  // namespace leonav
