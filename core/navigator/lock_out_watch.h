// Notices a filter that throws out nearly all that contradicts it, on and on, where too few
// satellites are left for a point solution to tell who is right.
#pragma once
#include "core/ekf/ekf.h"

namespace leonav {

class LockOutWatch {
 public:
  // True when half a minute of epochs, in sum, has spoken against the filter; it then starts
  // again. Against it: of two codes or more most are thrown out, and so are most Dopplers, or the
  // codes are off by more than any detour of a signal. An epoch of which most codes are kept counts
  // back. What houses do to codes alone does not count: it leaves the Dopplers of a vehicle at
  // rest, and what it does to those of one that moves passes with the street.
  bool add(const EkfUpdateResult& result, GpsTime time);
  void reset() { against_s_ = 0.0; }

 private:
  GpsTime last_;
  double against_s_ = 0.0;
};

}  // namespace leonav
