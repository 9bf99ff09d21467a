// The SbfStreamOptions are what a stream's configuration says of a Septentrio receiver's inertial
// sensor and of the corrections that it receives.
#pragma once

namespace leonav {

struct SbfStreamOptions {
  bool is_inertial = false;  // samples of the receiver's inertial sensor are published
  bool uses_pages = false;   // the corrections of Galileo's E6-B and of PPP-B2b are used
};

}  // namespace leonav
