// GrowthSinceLook is whether a counter has grown since the last look.
#pragma once
#include <cstdint>
#include <utility>

namespace leonav {

class GrowthSinceLook {
 public:
  bool look(std::int64_t count) { return count > std::exchange(count_, count); }

 private:
  std::int64_t count_ = 0;  // a counter begins at 0
};

}  // namespace leonav
