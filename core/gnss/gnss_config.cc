#include "core/gnss/gnss_config.h"

#include <initializer_list>

namespace leonav {
namespace {

SystemConfig system_config(char first, std::initializer_list<char> second) {
  SystemConfig config;
  config.enabled = true;
  config.signals.first_band = first;
  config.signals.second_bands.assign(second.begin(), second.end());
  return config;
}

}  // namespace

GnssConfig default_gnss_config() {
  GnssConfig config;
  config.systems[index_of(System::kGps)] = system_config('1', {'2', '5'});
  config.systems[index_of(System::kGalileo)] = system_config('1', {'5', '7'});
  config.systems[index_of(System::kBeidou)] = system_config('2', {'6'});
  config.systems[index_of(System::kLeo)] = system_config('1', {'2'});
  return config;
}

}  // namespace leonav
