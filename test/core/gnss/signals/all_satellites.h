// Every satellite that has a name.
#pragma once
#include <vector>

#include "core/gnss/signals/satellite.h"

namespace leonav::test {

inline std::vector<SatelliteId> all_satellites() {
  std::vector<SatelliteId> all;
  for (const System system : kSystems)
    for (std::uint16_t number = 1; number <= kHighestNumber[index_of(system)]; ++number)
      all.push_back({system, number});
  return all;
}

}  // namespace leonav::test
