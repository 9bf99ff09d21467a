#include "core/gnss/propagation/signal_bias_store.h"

#include <limits>

#include "core/base/capacity.h"
#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kTime = GpsTime::from_week_and_tow(2300, 1000.0);
constexpr SatelliteId kG05{System::kGps, 5};

SignalBias bias(const char* code, double bias_m) {
  return {kG05, *signal_from_string(code), BiasKind::kCode, kTime, bias_m};
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
  int others = 0;
  for (const char band : {'1', '2', '5'}) {
    for (char attribute = 'A'; attribute <= 'Z'; ++attribute) {
      if (others == static_cast<int>(kMaxSignalBiases)) break;
      if (band == '1' && attribute == 'C') continue;
      REQUIRE(store.add({kG05, {band, attribute}, BiasKind::kCode, kTime, 1.0}));
      ++others;
    }
  }
  CHECK_FALSE(store.code_delay(kG05, kTime, {'1', 'C'}));
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
}

}  // namespace leonav
