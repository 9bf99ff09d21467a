// Two ionosphere-free pairs of one satellite measure the same range. What differs, beyond the
// receiver's part that all satellites share, is the satellite's group delays: a check of their
// signs and sizes on recorded pseudoranges that needs neither orbits nor an atmosphere.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <vector>

#include "core/gnss/propagation/group_delay.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

namespace leonav {
namespace {

struct Comparison {
  const char* label;
  System system;
  NavigationMessage message;
  const char* first;   // of both pairs
  const char* second;  // of one pair
  const char* third;   // of the other
  double most_left;    // rms after correction may be at most this share of before
  std::map<SatelliteId, std::vector<double>> differences = {};
};

double pseudorange(const RawEpoch& epoch, SatelliteId satellite, const char* code) {
  for (const SignalObservation& o : epoch.observations) {
    if (o.satellite == satellite && o.code == *signal_from_string(code)) return o.pseudorange_m;
  }
  return kNotMeasured;
}

double ionosphere_free(System system, char band1, double p1, char band2, double p2) {
  const double f1 = std::pow(frequency_hz(system, band1), 2);
  const double f2 = std::pow(frequency_hz(system, band2), 2);
  return (f1 * p1 - f2 * p2) / (f1 - f2);
}

void gather(const RawEpoch& epoch, Comparison* c) {
  SatelliteId previous;
  for (const SignalObservation& o : epoch.observations) {
    if (o.satellite.system != c->system || o.satellite == previous) continue;
    previous = o.satellite;
    const double p1 = pseudorange(epoch, o.satellite, c->first);
    const double a = ionosphere_free(c->system, c->first[0], p1, c->second[0],
                                     pseudorange(epoch, o.satellite, c->second));
    const double b = ionosphere_free(c->system, c->first[0], p1, c->third[0],
                                     pseudorange(epoch, o.satellite, c->third));
    if (std::isfinite(a - b)) c->differences[o.satellite].push_back(a - b);
  }
}

double rms_about_mean(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

TEST_CASE("Group delays bring recorded signal pairs together", "[group_delay][data]") {
  if (!test::have_shared_data("station/ESBC00DNK_2020177_6H_30S.obs")) return;
  std::vector<Comparison> comparisons = {
      {"Galileo E1/E5a - E1/E5b", System::kGalileo, NavigationMessage::kGalileoInav, "1C", "5Q",
       "7Q", 0.4},
      {"BeiDou B1I/B3I - B1I/B2I", System::kBeidou, NavigationMessage::kBeidouD1, "2I", "6I", "7I",
       0.4},
      {"GPS L1/L2 - L1/L5", System::kGps, NavigationMessage::kGpsLnav, "1C", "2W", "5Q", 0.8}};
  ObservationReader reader(test::shared_data("station/ESBC00DNK_2020177_6H_30S.obs"));
  RawEpoch epoch;
  while (reader.next(&epoch)) {
    for (Comparison& c : comparisons) gather(epoch, &c);
  }
  const auto ephemerides =
      read_navigation(test::shared_data("station/ESBC00DNK_2020177.nav")).ephemerides;

  for (Comparison& c : comparisons) {
    std::vector<double> before, after;
    for (auto& entry : c.differences) {
      const auto& satellite = entry.first;
      auto& values = entry.second;
      const auto e = std::find_if(ephemerides.begin(), ephemerides.end(), [&](const Ephemeris& x) {
        return x.satellite == satellite &&
               (x.message == c.message || (c.system == System::kBeidou));
      });
      if (values.size() < 60 || e == ephemerides.end()) continue;
      std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                       values.end());
      const double median = values[values.size() / 2];
      const auto code = [](const char* text) { return *signal_from_string(text); };
      before.push_back(median);
      after.push_back(median - group_delay(*e, code(c.first), code(c.second)).delay_m +
                      group_delay(*e, code(c.first), code(c.third)).delay_m);
    }
    REQUIRE(before.size() >= 8);
    std::cout << c.label << ": " << before.size() << " satellites, rms " << rms_about_mean(before)
              << " m, corrected " << rms_about_mean(after) << " m\n";
    CHECK(rms_about_mean(after) < c.most_left * rms_about_mean(before));
  }
}

}  // namespace leonav
