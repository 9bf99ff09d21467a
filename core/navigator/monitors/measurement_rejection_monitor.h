// MeasurementRejectionMonitor finds a filter that keeps rejecting nearly all measurements while too
// few satellites are left to check it.
#pragma once
#include "core/filter/ekf.h"

namespace leonav {

// The part of the filter that the rejected measurements contradict: none, its clocks, or its
// position.
enum class RejectionVerdict : unsigned char { kNone, kClocks, kPosition };

// MeasurementRejectionMonitor counts seconds of epochs with evidence against the filter's clocks
// and against its position.
class MeasurementRejectionMonitor {
 public:
  // Adds an epoch and returns kNone until epochs of 30 s in sum are evidence against the filter;
  // then it returns the verdict and starts anew. `result` is that of the filter's update with
  // `epoch`.
  //
  // Only epochs that no point solution could check are evidence: those with fewer than two codes
  // beyond the number that position and clocks need. An epoch is evidence against the filter if it
  // has at least two codes, most of them are rejected, and one of these holds:
  // - The common innovation of the codes exceeds 100 m and ten times their discrepancy. That is
  //   evidence against the clocks (kClocks).
  // - The discrepancy of the codes exceeds 300 m, more than any detour of a reflected signal.
  // - Most Dopplers are rejected as well (or, without Dopplers, the discrepancy exceeds 100 m), and
  //   carriers of earlier arcs do not confirm the filter.
  //
  // The discrepancy is the second largest deviation of the innovations from their median. An epoch
  // of which most codes are used counts against the evidence. Reflections by buildings that disturb
  // only codes are not evidence: they affect neither carriers nor the Dopplers of a vehicle at
  // rest.
  RejectionVerdict add(const EkfUpdateResult& result, const MeasurementEpoch& epoch, GpsTime time);
  void reset() { position_evidence_s_ = clock_evidence_s_ = 0.0; }
  // Returns whether the last epoch of which most codes were rejected had as many codes as position
  // and clocks need.
  bool enough_to_start() const { return enough_to_start_; }
  // These return the discrepancies of codes and Dopplers in that epoch.
  double code_discrepancy_m() const { return code_discrepancy_m_; }
  double doppler_discrepancy_m_s() const { return doppler_discrepancy_m_s_; }

 private:
  GpsTime last_;
  double position_evidence_s_ = 0.0, clock_evidence_s_ = 0.0;
  bool enough_to_start_ = false;
  double code_discrepancy_m_ = 0.0, doppler_discrepancy_m_s_ = 0.0;
};

}  // namespace leonav
