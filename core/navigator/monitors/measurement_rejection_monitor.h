// Notices a filter that throws out nearly all that contradicts it, on and on, where too few
// satellites are left for a point solution to tell who is right.
#pragma once
#include "core/filter/ekf.h"

namespace leonav {

enum class RejectionVerdict : unsigned char { kNone, kClocks, kPosition };

class MeasurementRejectionMonitor {
 public:
  // What has become of it: kNone until half a minute of epochs, in sum, has spoken against the
  // filter; it then starts again. `result`: what the filter made of `epoch`.
  //
  // Only epochs count that no point solution could check: with less than two codes beyond a
  // position and the clocks. Against the filter is one of whose codes (two or more) most are thrown
  // out, if
  // - most Dopplers are too, or there is none and the codes are off by 100 m, and the carriers of
  //   arcs from before, if any, do not confirm the filter; or, whatever confirms it,
  // - the codes are off by more than any detour of a signal, 300 m; or
  // - they are off by hardly more than what they have in common: that is the clocks' (kClocks).
  // "Off" is without what all have in common, and of the second worst. An epoch of which most codes
  // are kept counts back. What houses do to codes alone does not count: it leaves carriers and the
  // Dopplers of a vehicle at rest.
  RejectionVerdict add(const EkfUpdateResult& result, const MeasurementEpoch& epoch, GpsTime time);
  void reset() { position_evidence_s_ = clock_evidence_s_ = 0.0; }
  // Of the last epoch: as many codes as a position and the clocks need.
  bool enough_to_start() const { return enough_to_start_; }
  double code_discrepancy_m() const { return code_discrepancy_m_; }  // of the last epoch
  double doppler_discrepancy_m_s() const {
    return doppler_discrepancy_m_s_;
  }  // likewise of the Dopplers

 private:
  GpsTime last_;
  double position_evidence_s_ = 0.0, clock_evidence_s_ = 0.0;
  bool enough_to_start_ = false;
  double code_discrepancy_m_ = 0.0, doppler_discrepancy_m_s_ = 0.0;
};

}  // namespace leonav
