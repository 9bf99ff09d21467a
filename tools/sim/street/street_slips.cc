#include "tools/sim/street/street_slips.h"

#include <cmath>

namespace leonav::sim {
namespace {

void add(double cycles, bool told, CycleSlip* slip) {
  slip->cycles += cycles;
  slip->told = slip->told || told;
}

}  // namespace

void add_random_slip(int max_cycles, bool told, GaussianGenerator* random,
                     std::array<CycleSlip, kTrackedSignals>* slips) {
  const double which = random->uniform();
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    const double size = std::ceil(random->uniform() * max_cycles);
    const double sign = random->uniform() <= 0.5 ? -1.0 : 1.0;
    const bool hit = s == 0 ? which <= 2.0 / 3.0 : which > 1.0 / 3.0;
    if (hit) add(sign * size, told, &(*slips)[s]);
  }
}

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
  const double cycle = random_.uniform() <= 0.5 ? -1.0 : 1.0;
  const bool single = kind <= config_.single_share;
  if (!single && kind > config_.single_share + config_.pair_share) {
    return add_random_slip(config_.max_cycles, told, &random_, slips);
  }
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    if (!single || (s == 0) == (which <= 0.5)) add(cycle, told, &(*slips)[s]);
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
