#include "tools/sim/sky/group_delays.h"

namespace leonav::sim {
namespace {

double squared_ratio(System system, char numerator, char denominator) {
  const double ratio = frequency_hz(system, numerator) / frequency_hz(system, denominator);
  return ratio * ratio;
}

// f1^2 T1 = f6^2 T6 (the pair has no delay) and T1 - T6 = TGD1.
double b3i_delay_m(const BroadcastDelays& delays) {
  return delays[0] / (squared_ratio(System::kBeidou, '6', '2') - 1.0);
}

}  // namespace

double signal_delay_m(System system, const BroadcastDelays& delays, char band) {
  switch (system) {
    case System::kGps:
      return delays[0] * squared_ratio(system, '1', band);
    case System::kGalileo:
      if (band == '7') return delays[0] + (squared_ratio(system, '1', band) - 1.0) * delays[1];
      return delays[0] * squared_ratio(system, '1', band);
    case System::kBeidou: {
      const double reference = b3i_delay_m(delays);
      if (band == '2' || band == '1') return reference + delays[0];
      return band == '7' ? reference + delays[1] : reference;
    }
    case System::kLeo:
      break;
  }
  return 0.0;
}

double broadcast_reference_m(NavigationMessage message, const BroadcastDelays& delays) {
  switch (message) {
    case NavigationMessage::kGalileoInav:
      return delays[0] - delays[1];
    case NavigationMessage::kBeidouD1:
    case NavigationMessage::kBeidouD2:
    case NavigationMessage::kBeidouCnav1:
      return b3i_delay_m(delays);
    case NavigationMessage::kGpsLnav:
    case NavigationMessage::kGalileoFnav:
      break;
  }
  return 0.0;
}

}  // namespace leonav::sim
