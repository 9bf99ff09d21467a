// StreetSlips draws the cycle slips of one satellite's carriers.
#pragma once
#include <array>
#include <cstdint>

#include "tools/sim/motion/gaussian_generator.h"
#include "tools/sim/scenario/receiver_config.h"
#include "tools/sim/scenario/street_errors_config.h"
#include "tools/sim/street/cycle_slip.h"

namespace leonav::sim {

// Adds a slip of 1 to max_cycles cycles, up or down, to one signal or to both, with equal
// probability.
void add_random_slip(int max_cycles, bool told, GaussianGenerator* random,
                     std::array<CycleSlip, kTrackedSignals>* slips);

// Slips arrive as a Poisson process in time. Of three kinds one is drawn: one cycle on one signal;
// the same one cycle on both, which cancels in the difference of the signals' cycles; and a random
// number of cycles on one signal or on both.
class StreetSlips {
 public:
  StreetSlips(const StreetSlipsConfig& config, std::uint64_t key);

  // Returns the slips since the call before, up to time t; instants in order of time.
  std::array<CycleSlip, kTrackedSignals> until(double t);

 private:
  void draw_next(double after_s);
  void add_slip(std::array<CycleSlip, kTrackedSignals>* slips);

  StreetSlipsConfig config_;
  GaussianGenerator random_;
  double next_s_ = 0.0;
};

}  // namespace leonav::sim
