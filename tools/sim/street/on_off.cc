#include "tools/sim/street/on_off.h"

#include <cmath>
#include <limits>

namespace leonav::sim {

OnOff::OnOff(std::uint64_t key, double share, double duration_s)
    : random_(key),
      mean_on_s_(duration_s),
      mean_off_s_(share > 0.0 ? duration_s * (1.0 - share) / share
                              : std::numeric_limits<double>::infinity()),
      on_(random_.uniform() <= share),
      until_s_(draw_end()) {}

double OnOff::draw_end() {
  return since_s_ - std::log(random_.uniform()) * (on_ ? mean_on_s_ : mean_off_s_);
}

void OnOff::advance(double t) {
  while (t >= until_s_) {
    since_s_ = until_s_;
    on_ = !on_;
    ++episode_;
    until_s_ = draw_end();
  }
}

}  // namespace leonav::sim
