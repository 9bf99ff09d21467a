#include "tools/sim/signals/signal_plan.h"

#include <array>

namespace leonav::sim {

std::span<const SignalCode> signals_of(const Scenario& scenario, System system) {
  static constexpr std::array<SignalCode, 2> kGps{{{'1', 'C'}, {'2', 'W'}}};
  static constexpr std::array<SignalCode, 2> kGalileo{{{'1', 'C'}, {'5', 'Q'}}};
  static constexpr std::array<SignalCode, 2> kBeidou{{{'2', 'I'}, {'6', 'I'}}};
  switch (system) {
    case System::kGalileo:
      return kGalileo;
    case System::kBeidou:
      return kBeidou;
    case System::kLeo:
      return scenario.constellations[index_of(system)].signals;
    case System::kGps:
      break;
  }
  return kGps;
}

}  // namespace leonav::sim
