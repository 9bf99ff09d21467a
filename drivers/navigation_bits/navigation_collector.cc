#include "drivers/navigation_bits/navigation_collector.h"

#include <algorithm>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/navigation_bits/beidou_cnav1.h"

namespace leonav {
namespace {

constexpr double kDelayRepeat_s = 3600.0;

SubframeStatus status_of(CnavStatus status) {
  switch (status) {
    case CnavStatus::kDelays:
      return SubframeStatus::kUsed;
    case CnavStatus::kOtherType:
      return SubframeStatus::kOtherMessage;
    case CnavStatus::kBadChecksum:
      return SubframeStatus::kBadParity;
    case CnavStatus::kWrongSatellite:
      return SubframeStatus::kWrongSatellite;
  }
  return SubframeStatus::kOtherMessage;
}

}  // namespace

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

NavigationUpdate NavigationCollector::add_gps_cnav(std::span<const std::uint8_t> bits,
                                                   const SubframeOrigin& origin) {
  std::vector<SignalBias> biases;
  const CnavStatus status = read_gps_cnav_delays(bits, origin.satellite, origin.now, &biases);
  return finish_delays(status, std::move(biases), origin.now);
}

NavigationUpdate NavigationCollector::add_bcnav1(std::span<const std::uint8_t> bits,
                                                 const SubframeOrigin& origin) {
  std::vector<SignalBias> biases;
  const CnavStatus status = read_bcnav1_delays(bits, origin.satellite, origin.now, &biases);
  Ephemeris ephemeris;
  if (status == CnavStatus::kDelays) {
    const SubframeStatus elements = read_bcnav1_elements(bits, origin, &ephemeris);
    if (elements != SubframeStatus::kUsed) {
      count(elements);
      return {};
    }
  }
  NavigationUpdate update = finish_delays(status, std::move(biases), origin.now);
  if (status == CnavStatus::kDelays && is_new_issue(ephemeris)) update.ephemeris = ephemeris;
  return update;
}

NavigationUpdate NavigationCollector::add_bcnav2(std::span<const std::uint8_t> bits,
                                                 const SubframeOrigin& origin) {
  std::vector<SignalBias> biases;
  const CnavStatus status = read_bcnav2_delays(bits, origin.satellite, origin.now, &biases);
  return finish_delays(status, std::move(biases), origin.now);
}

NavigationUpdate NavigationCollector::finish_delays(CnavStatus status,
                                                    std::vector<SignalBias> biases, GpsTime now) {
  count(status_of(status));
  NavigationUpdate update;
  if (are_new(biases, now)) update.biases = std::move(biases);
  return update;
}

bool NavigationCollector::are_new(const std::vector<SignalBias>& biases, GpsTime now) {
  const bool any_new = std::any_of(biases.begin(), biases.end(), [&](const SignalBias& bias) {
    const auto last = reported_delays_.find({bias.satellite, bias.code});
    return last == reported_delays_.end() || last->second.first != bias.bias_m ||
           seconds_between(now, last->second.second) >= kDelayRepeat_s;
  });
  if (!any_new) return false;
  for (const SignalBias& bias : biases)
    reported_delays_[{bias.satellite, bias.code}] = {bias.bias_m, now};
  ++counters_.delays;
  return true;
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
