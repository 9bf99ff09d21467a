#include "core/gnss/measurement/gnss_config.h"

#include <initializer_list>

namespace leonav {
namespace {

SystemConfig system_config(char first, std::initializer_list<char> second,
                           std::initializer_list<char> attributes = {}) {
  SystemConfig config;
  config.enabled = true;
  config.signals.first_band = first;
  config.signals.second_bands.assign(second.begin(), second.end());
  config.signals.attributes.assign(attributes.begin(), attributes.end());
  return config;
}

}  // namespace

GnssConfig default_gnss_config() {
  GnssConfig config;
  config.systems[index_of(System::kGps)] =
      // L2 P(W) comes before L2C: only the newer satellites have L2C, and the two differ by metres
      // in a combination with L1 C/A.
      system_config('1', {'2', '5'}, {'C', 'P', 'W', 'X', 'L', 'S', 'Q', 'I'});
  config.systems[index_of(System::kGalileo)] = system_config('1', {'5', '7'});
  config.systems[index_of(System::kBeidou)] = system_config('2', {'6'});
  config.systems[index_of(System::kLeo)] = system_config('1', {'2'});
  return config;
}

}  // namespace leonav
