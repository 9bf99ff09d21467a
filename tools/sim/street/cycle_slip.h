// CycleSlip is a change of a carrier's cycles between two epochs.
#pragma once

namespace leonav::sim {

// Told: with loss of lock and a lock time that begins anew.
struct CycleSlip {
  double cycles = 0.0;  // 0: none
  bool told = false;
};

}  // namespace leonav::sim
