#include "drivers/epoch/epoch_capacity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "core/gnss/preprocessing/signal_selection.h"
#include "support/catch.h"

using namespace leonav;

namespace {

SignalObservation observation(SatelliteId satellite, const char* code) {
  SignalObservation o;
  o.satellite = satellite;
  o.code = *signal_from_string(code);
  o.pseudorange_m = 2.2e7 + satellite.number;
  o.cn0_dbhz = 40.0;
  return o;
}

// Twelve signals of a satellite and more than 512 of an epoch.
std::vector<SignalObservation> crowded_sky() {
  const std::map<System, std::vector<const char*>> codes = {
      {System::kGps, {"1C", "1S", "1L", "1X", "1W", "1P", "2S", "2L", "2W", "2P", "5I", "5Q"}},
      {System::kGalileo, {"1B", "1C", "1X", "5I", "5Q", "5X", "7I", "7Q", "8Q", "6B", "6C", "6X"}},
      {System::kBeidou, {"1D", "1P", "1X", "2I", "2X", "5D", "5P", "6I", "6Q", "7D", "7I", "8P"}}};
  std::vector<SignalObservation> all;
  for (const auto& [system, of_system] : codes) {
    for (std::uint16_t number = 1; number <= 20; ++number) {
      for (const char* code : of_system) all.push_back(observation({system, number}, code));
    }
  }
  return all;
}

using Choice = std::map<SatelliteId, std::vector<SignalCode>>;

// What the estimator takes of each satellite: the pair, then one signal of every band.
Choice choice_of(const std::vector<SignalObservation>& signals, const GnssConfig& config) {
  std::map<SatelliteId, std::vector<SignalObservation>> of;
  for (const SignalObservation& o : signals) of[o.satellite].push_back(o);
  Choice choice;
  for (const auto& [satellite, own] : of) {
    const SelectedSignals s =
        select_signals(own, config.systems[index_of(satellite.system)].signals, 0.0);
    if (s.first != nullptr) choice[satellite].push_back(s.first->code);
    if (s.second != nullptr) choice[satellite].push_back(s.second->code);
    for (const SignalObservation* o : s.bands) choice[satellite].push_back(o->code);
  }
  return choice;
}

}  // namespace

TEST_CASE("what does not fit into an epoch changes nothing that the estimator chooses") {
  std::mt19937 random(20261127);
  const GnssConfig config = default_gnss_config();
  std::vector<SignalObservation> signals = crowded_sky();
  REQUIRE(signals.size() > kMaxObservations);
  // A preferred code that was not received is no reason to lose the one that was.
  for (SignalObservation& o : signals) {
    if (o.satellite.number % 3 == 0 && (o.code.attribute == 'C' || o.code.attribute == 'X'))
      o.pseudorange_m = kNotMeasured;
  }
  const Choice before = choice_of(signals, config);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(signals.begin(), signals.end(), random);
    std::vector<SignalObservation> limited = signals;
    RawEpoch epoch;
    EpochCapacity capacity;
    capacity.fit(&limited, &epoch);
    REQUIRE(epoch.observations.size() == kMaxObservations);
    CHECK(capacity.losses().usable == 0);
    CHECK(capacity.losses().spare == signals.size() - kMaxObservations);
    CHECK(choice_of({epoch.observations.begin(), epoch.observations.end()}, config) == before);
    CHECK(std::is_sorted(epoch.observations.begin(), epoch.observations.end(),
                         [](const SignalObservation& a, const SignalObservation& b) {
                           return std::pair(a.satellite, a.code) < std::pair(b.satellite, b.code);
                         }));
  }
}

TEST_CASE("an epoch that fits is sorted and nothing else") {
  std::vector<SignalObservation> signals = crowded_sky();
  std::erase_if(signals, [](const SignalObservation& o) { return o.satellite.number > 14; });
  REQUIRE(signals.size() <= kMaxObservations);
  std::reverse(signals.begin(), signals.end());
  const std::size_t count = signals.size();
  RawEpoch epoch;
  EpochCapacity capacity;
  capacity.fit(&signals, &epoch);
  CHECK(epoch.observations.size() == count);
  CHECK(spare_text(capacity.losses()).empty());
  CHECK(usable_text(capacity.losses()).empty());
}

TEST_CASE("a loss that the estimator feels is told apart, and a band of no system goes first") {
  std::vector<SignalObservation> signals;
  for (std::uint16_t number = 1; number <= 300; ++number) {
    for (const char* code : {"1A", "2W", "1C"})
      signals.push_back(observation({System::kLeo, number}, code));
    signals[signals.size() - 3].code.band = '0';
  }
  RawEpoch epoch;
  EpochCapacity capacity;
  capacity.fit(&signals, &epoch);
  CHECK(capacity.losses().usable == 600 - kMaxObservations);
  CHECK(capacity.losses().spare == 300);
  CHECK(spare_text(capacity.losses())
            .starts_with("signal beyond the 512 that an epoch holds (leo 0A)"));
  CHECK(usable_text(capacity.losses()).find("(leo 2W)") != std::string::npos);
  CHECK(
      summary_of(capacity.losses()) ==
      "beyond the 512 that an epoch holds: 300 spare signals (leo 0A), 88 usable signals (leo 2W)");
  CHECK(summary_of({}).empty());
}

TEST_CASE("no system has more bands than the models take of a satellite") {
  for (const System system : kSystems) {
    std::size_t bands = 0;
    for (char band = '1'; band <= '9'; ++band) bands += frequency_hz(system, band) > 0.0;
    CHECK(bands <= kMaxSignals);
  }
}
