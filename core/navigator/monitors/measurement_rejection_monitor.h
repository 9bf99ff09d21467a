// MeasurementRejectionMonitor detects a filter that persistently rejects nearly all measurements
// while too few satellites are left for a point solution to decide who is right.
#pragma once
#include "core/filter/ekf.h"

namespace leonav {

enum class RejectionVerdict : unsigned char { kNone, kClocks, kPosition };

class MeasurementRejectionMonitor {
 public:
  // Adds an epoch with the result of its update. Returns kNone until the evidence against the
  // filter amounts to half a minute of epochs; then the count starts again.
  //
  // Only epochs count that no point solution can check: fewer than two codes beyond a position and
  // the clocks. An epoch is evidence against the filter if it has two or more codes, most of which
  // are rejected, and
  // - most Dopplers are rejected too, or there is none and the codes are off by 100 m, and carriers
  //   of older arcs, if any, do not confirm the filter; or, whatever confirms it,
  // - the codes are off by more than any detour of a signal, 300 m; or
  // - their common part explains nearly all: then the clocks are wrong (kClocks).
  // "Off" is the second largest innovation, with the common part removed. An epoch with most codes
  // accepted counts back. Reflections alone do not count: they affect codes, but neither carriers
  // nor the Dopplers of a vehicle at rest.
  RejectionVerdict add(const EkfUpdateResult& result, const MeasurementEpoch& epoch, GpsTime time);
  void reset() { position_evidence_s_ = clock_evidence_s_ = 0.0; }
  // True if the last epoch had as many codes as a position and the clocks need.
  bool enough_to_start() const { return enough_to_start_; }
  // By how much the codes and the Dopplers of the last epoch were off.
  double code_discrepancy_m() const { return code_discrepancy_m_; }
  double doppler_discrepancy_m_s() const { return doppler_discrepancy_m_s_; }

 private:
  GpsTime last_;
  double position_evidence_s_ = 0.0, clock_evidence_s_ = 0.0;
  bool enough_to_start_ = false;
  double code_discrepancy_m_ = 0.0, doppler_discrepancy_m_s_ = 0.0;
};

}  // namespace leonav
