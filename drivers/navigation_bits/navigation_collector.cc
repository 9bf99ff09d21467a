#include "drivers/navigation_bits/navigation_collector.h"

#include "core/gnss/orbits/satellite_state.h"

namespace leonav {

NavigationUpdate NavigationCollector::add_gps_lnav(
    std::span<const std::uint32_t, GpsLnav::kWords> words, const SubframeOrigin& origin) {
  NavigationUpdate update;
  const SubframeStatus status = gps_lnav_[origin.satellite.number].add(words, origin, &update);
  return finish(status, update);
}

NavigationUpdate NavigationCollector::add_galileo_inav(
    std::span<const std::uint32_t, GalileoInav::kWords> words, const SubframeOrigin& origin) {
  NavigationUpdate update;
  const SubframeStatus status = galileo_inav_[origin.satellite.number].add(words, origin, &update);
  return finish(status, update);
}

NavigationUpdate NavigationCollector::add_galileo_fnav(
    std::span<const std::uint32_t, GalileoFnav::kWords> words, const SubframeOrigin& origin) {
  NavigationUpdate update;
  const SubframeStatus status = galileo_fnav_[origin.satellite.number].add(words, origin, &update);
  return finish(status, update);
}

NavigationUpdate NavigationCollector::add_beidou(std::span<const std::uint32_t, kBeidouWords> words,
                                                 const SubframeOrigin& origin) {
  NavigationUpdate update;
  const std::size_t number = origin.satellite.number;
  const SubframeStatus status = is_beidou_geostationary(origin.satellite)
                                    ? beidou_d2_[number].add(words, origin, &update)
                                    : beidou_d1_[number].add(words, origin, &update);
  return finish(status, update);
}

NavigationUpdate NavigationCollector::finish(SubframeStatus status, NavigationUpdate update) {
  count(status);
  if (update.ephemeris && !is_new_issue(*update.ephemeris)) update.ephemeris.reset();
  return update;
}

void NavigationCollector::count(SubframeStatus status) {
  switch (status) {
    case SubframeStatus::kUsed:
      ++counters_.subframes;
      break;
    case SubframeStatus::kOtherMessage:
      ++counters_.other_message;
      break;
    case SubframeStatus::kBadParity:
      ++counters_.bad_parity;
      break;
    case SubframeStatus::kBadWeek:
      ++counters_.bad_week;
      break;
    case SubframeStatus::kWrongSatellite:
      ++counters_.wrong_satellite;
      break;
  }
}

bool NavigationCollector::is_new_issue(const Ephemeris& ephemeris) {
  if (!is_sane(ephemeris)) {
    ++counters_.not_sane;
    return false;
  }
  if (!reported_.is_new(ephemeris)) return false;
  ++counters_.ephemerides;
  return true;
}

}  // namespace leonav
