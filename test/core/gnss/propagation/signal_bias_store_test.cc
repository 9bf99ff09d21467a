#include "core/gnss/propagation/signal_bias_store.h"

#include <limits>
#include <string>
#include <vector>

#include "core/base/capacity.h"
#include "orbits/gps_5_at_noon.h"
#include "signals/all_satellites.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::kG05;

const GpsTime kTime = GpsTime::from_week_and_tow(2300, 1000.0);

SignalBias bias(const char* code, double bias_m) {
  return {kG05, *signal_from_string(code), BiasKind::kCode, kTime, bias_m};
}

// As many biases of other signals as there is room for of one satellite.
void fill(SignalBiasStore* store) {
  constexpr int kCapacity = static_cast<int>(SignalBiasStore::kMaxIntervals * kMaxSignalBiases);
  int others = 0;
  for (const char band : {'1', '2', '5'}) {
    for (char attribute = 'A'; attribute <= 'Z' && others < kCapacity; ++attribute) {
      const std::string code{band, attribute};
      if (code == "1C" || code == "2W") continue;
      REQUIRE(store->add(bias(code.c_str(), 1.0)));
      ++others;
    }
  }
}

}  // namespace

TEST_CASE("A pair's delay is the combination of its signals' biases") {
  SignalBiasStore store;
  CHECK_FALSE(store.code_delay(kG05, kTime, {'1', 'C'}));
  REQUIRE(store.add(bias("1C", 2.0)));
  REQUIRE(store.add(bias("2W", -1.0)));
  CHECK(store.code_delay(kG05, kTime, {'1', 'C'})->delay_m == 2.0);
  // GPS L1/L2: 2.5457 and -1.5457 (IS-GPS-200 20.3.3.3.3.3).
  CHECK(store.code_delay(kG05, kTime, {'1', 'C'}, {'2', 'W'})->delay_m ==
        Approx(2.0 * 2.545728 + 1.0 * 1.545728));
  CHECK_FALSE(store.code_delay(kG05, kTime, {'1', 'C'}, {'5', 'Q'}));
  CHECK_FALSE(store.code_delay(kG05, kTime, {'1', 'W'}, {'2', 'W'}));
  CHECK_FALSE(store.code_delay({System::kGps, 6}, kTime, {'1', 'C'}));
  CHECK_FALSE(store.code_delay(kG05, kTime.plus_seconds(86'401.0), {'1', 'C'}));
}

TEST_CASE("The newest bias of a signal counts, and a full table drops what arrived first") {
  SignalBiasStore store;
  REQUIRE(store.add(bias("1C", 2.0)));
  REQUIRE(store.add(bias("1C", 3.0)));
  CHECK(store.code_delay(kG05, kTime, {'1', 'C'})->delay_m == 3.0);
  SignalBiasStore full;
  REQUIRE(full.add(bias("1C", 2.0)));
  fill(&full);
  CHECK_FALSE(full.code_delay(kG05, kTime, {'1', 'C'}));
}

TEST_CASE("A bias in use is not the one that a full table drops") {
  SignalBiasStore store;
  for (const char* code : {"1C", "2W"}) REQUIRE(store.add(bias(code, 2.0)));
  for (const double later_s : {0.0, 30.0, 80.0}) {
    const GpsTime now = kTime.plus_seconds(later_s);
    CAPTURE(later_s);
    CHECK(store.code_delay(kG05, now, {'1', 'C'}, {'2', 'W'}));
    fill(&store);
  }
}

TEST_CASE("Beyond the room for all satellites each loses the bias that arrived first") {
  SignalBiasStore store;
  const std::vector<SatelliteId> all = test::all_satellites();
  constexpr int kEach = static_cast<int>(kMaxProductBiases / kMaxEphemerisSatellites);
  for (int i = 0; i <= kEach; ++i)
    for (const SatelliteId satellite : all)
      REQUIRE(store.add(
          {satellite, {'1', static_cast<char>('A' + i)}, BiasKind::kCode, kTime, 1.0 + i}));
  for (const SatelliteId satellite : all) {
    CAPTURE(to_string(satellite.system), satellite.number);
    for (int i = 0; i <= kEach; ++i) {
      const auto delay = store.code_delay(satellite, kTime, {'1', static_cast<char>('A' + i)});
      CHECK(delay.has_value() == (i > 0));
      if (delay) CHECK(delay->delay_m == 1.0 + i);
    }
  }
}

TEST_CASE("A bias that is new is told from one that is followed by the next") {
  SignalBiasStore store;
  CHECK_FALSE(store.has(bias("1C", 2.0)));
  CHECK(store.count_in_system(bias("1C", 2.0)) == 0);
  REQUIRE(store.add(bias("1C", 2.0)));
  SignalBias next = bias("1C", 3.0);
  next.time = kTime.plus_seconds(10.0);
  CHECK(store.has(next));
  next.kind = BiasKind::kBroadcastCode;
  CHECK_FALSE(store.has(next));
  next = bias("1C", 3.0);
  next.satellite.number = 6;
  CHECK_FALSE(store.has(next));
  CHECK(store.count_in_system(next) == 1);
  REQUIRE(store.add(next));
  CHECK(store.count_in_system(next) == 2);
  next.satellite.system = System::kGalileo;
  CHECK(store.count_in_system(next) == 0);
}

TEST_CASE("Biases that no satellite can have are refused, those of carriers are not kept") {
  SignalBiasStore store;
  CHECK_FALSE(store.add(bias("9C", 1.0)));
  CHECK_FALSE(store.add(bias("1C", 1001.0)));
  CHECK_FALSE(store.add(bias("1C", std::numeric_limits<double>::quiet_NaN())));
  SignalBias other = bias("1C", 1.0);
  other.satellite.number = 0;
  CHECK_FALSE(store.add(other));
  other = bias("1C", 1.0);
  other.time = GpsTime();
  CHECK_FALSE(store.add(other));
  other = bias("1C", 1.0);
  other.kind = BiasKind::kPhase;
  CHECK(store.add(other));
  CHECK_FALSE(store.code_delay(kG05, kTime, {'1', 'C'}));
  other = bias("1C", 1.0);
  other.valid_from = other.valid_until = kTime;
  CHECK_FALSE(store.add(other));
}

TEST_CASE("A bias outside its validity is not used, and that of the next interval can come ahead") {
  const GpsTime midnight = kTime.plus_seconds(3600.0);
  SignalBias today = bias("1C", 1.0), tomorrow = bias("1C", 2.0);
  today.valid_from = midnight.plus_seconds(-86'400.0);
  today.valid_until = tomorrow.valid_from = midnight;
  tomorrow.valid_until = midnight.plus_seconds(86'400.0);
  SignalBiasStore store;
  REQUIRE(store.add(today));
  REQUIRE(store.add(tomorrow));
  const auto at = [&](double seconds) {
    const auto delay = store.code_delay(kG05, midnight.plus_seconds(seconds), {'1', 'C'});
    return delay ? delay->delay_m : 0.0;
  };
  CHECK(at(-86'400.001) == 0.0);
  CHECK(at(-86'400.0) == 1.0);
  CHECK(at(-0.001) == 1.0);
  CHECK(at(0.0) == 2.0);
  // Longer than a day after it was received: the validity that is stated counts.
  CHECK(at(86'399.0) == 2.0);
  CHECK(at(86'400.0) == 0.0);
  // The same interval anew replaces; a pair needs both of its signals to hold.
  tomorrow.bias_m = 3.0;
  REQUIRE(store.add(tomorrow));
  CHECK(at(0.0) == 3.0);
  SignalBias second = bias("2W", 1.0);
  second.valid_until = midnight;
  REQUIRE(store.add(second));
  CHECK(store.code_delay(kG05, midnight.plus_seconds(-1.0), {'1', 'C'}, {'2', 'W'}));
  CHECK_FALSE(store.code_delay(kG05, midnight, {'1', 'C'}, {'2', 'W'}));
}

TEST_CASE("A full table drops a bias that has ended before one that holds") {
  SignalBiasStore store;
  REQUIRE(store.add(bias("1C", 1.0)));  // arrived first and holds
  SignalBias ended = bias("2W", 1.0);
  ended.valid_from = kTime.plus_seconds(-100.0);
  ended.valid_until = kTime;
  REQUIRE(store.add(ended));
  constexpr int kOthers = static_cast<int>(SignalBiasStore::kMaxIntervals * kMaxSignalBiases) - 1;
  for (int i = 0; i < kOthers; ++i) {
    const char band = i < 26 ? '5' : '2';
    const SignalCode code{band, static_cast<char>('A' + i % 26)};
    if (code == SignalCode{'2', 'W'}) continue;
    REQUIRE(store.add({kG05, code, BiasKind::kCode, kTime, 1.0}));
  }
  CHECK(store.code_delay(kG05, kTime, {'1', 'C'}));
  CHECK_FALSE(store.code_delay(kG05, kTime.plus_seconds(-1.0), {'2', 'W'}));
}

TEST_CASE("Biases against the broadcast clock and those against a product's stay apart") {
  SignalBiasStore store;
  REQUIRE(store.add(bias("1C", 1.0)));
  SignalBias broadcast = bias("1C", -4.0);
  broadcast.kind = BiasKind::kBroadcastCode;
  CHECK_FALSE(store.broadcast_delay(kG05, kTime, {'1', 'C'}));
  REQUIRE(store.add(broadcast));
  CHECK(store.code_delay(kG05, kTime, {'1', 'C'})->delay_m == 1.0);
  CHECK(store.broadcast_delay(kG05, kTime, {'1', 'C'})->delay_m == -4.0);
  CHECK(store.broadcast_delay(kG05, kTime, {'1', 'C'})->sigma_m >
        store.code_delay(kG05, kTime, {'1', 'C'})->sigma_m);
}

}  // namespace leonav
