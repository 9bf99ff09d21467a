// The UbxStreamOptions are what a stream's configuration says of a u-blox receiver's own inertial
// sensor, of another sensor's pulses at its inputs, and of the corrections that it receives.
#pragma once
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {

// How pulses of an inertial sensor reach the receiver.
struct PulseInput {
  int input = 0;            // 0: EXTINT0, 1: EXTINT1
  bool is_falling = false;  // the edge that is in time
  double delay_s = 0.0;     // from a sample's time to the edge
};

struct UbxStreamOptions {
  bool is_inertial = false;  // samples of the receiver's own sensor are published
  ImuStampOptions stamps;    // of these
  PulseInput pulse_input;
  bool uses_pages = false;  // the corrections of Galileo's E6-B are used
};

}  // namespace leonav
