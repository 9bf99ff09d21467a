#include "tools/sim/street/street_slips.h"

#include <cmath>

namespace leonav::sim {

StreetSlips::StreetSlips(const StreetSlipsConfig& config, std::uint64_t key)
    : config_(config), random_(key) {
  draw_next(0.0);
}

void StreetSlips::draw_next(double after_s) {
  next_s_ = after_s - config_.interval_s * std::log(random_.uniform());
}

void StreetSlips::add_slip(std::array<CycleSlip, kTrackedSignals>* slips) {
  const double kind = random_.uniform(), which = random_.uniform();
  const bool told = random_.uniform() <= config_.told_share;
  const double sign = random_.uniform() <= 0.5 ? -1.0 : 1.0;
  const bool single = kind <= config_.single_share;
  const bool pair = !single && kind <= config_.single_share + config_.pair_share;
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    const double size = std::ceil(random_.uniform() * config_.max_cycles);
    const double own_sign = random_.uniform() <= 0.5 ? -1.0 : 1.0;
    const bool is_first = s == 0;
    const bool hit = pair || (single ? is_first == (which <= 0.5)
                                     : (is_first ? which <= 2.0 / 3.0 : which > 1.0 / 3.0));
    if (!hit) continue;
    (*slips)[s].cycles += single || pair ? sign : own_sign * size;
    (*slips)[s].told = (*slips)[s].told || told;
  }
}

std::array<CycleSlip, kTrackedSignals> StreetSlips::until(double t) {
  std::array<CycleSlip, kTrackedSignals> slips;
  while (next_s_ <= t) {
    add_slip(&slips);
    draw_next(next_s_);
  }
  return slips;
}

}  // namespace leonav::sim
