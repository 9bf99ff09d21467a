#include "core/gnss/signals/band_plan.h"

#include "core/gnss/signals/signal.h"
#include "support/catch.h"

namespace leonav {

TEST_CASE("By default LEO satellites transmit on GPS L1 and L2 to the last bit", "[band_plan]") {
  const BandPlan plan;
  CHECK(plan.frequency_hz(System::kLeo, '1') == 1575.42e6);
  CHECK(plan.frequency_hz(System::kLeo, '2') == 1227.60e6);
  CHECK(plan.wavelength_m(System::kLeo, '1') == wavelength_m(System::kGps, '1'));
  CHECK(plan.wavelength_m(System::kLeo, '2') == wavelength_m(System::kGps, '2'));
  for (const char band : {'\0', '0', '3', '9', 'C', ' '}) {
    CHECK(plan.frequency_hz(System::kLeo, band) == 0.0);
    CHECK(plan.wavelength_m(System::kLeo, band) == 0.0);
  }
}

TEST_CASE("Configured bands are those of LEO satellites only", "[band_plan]") {
  BandPlan plan;
  plan.set_leo('9', 2492.028e6);
  plan.set_leo('3', 5020.5e6);
  plan.set_leo('1', 0.0);
  plan.set_leo('0', 1e9);  // no band
  plan.set_leo('C', 1e9);
  CHECK(plan.frequency_hz(System::kLeo, '9') == 2492.028e6);
  CHECK(plan.wavelength_m(System::kLeo, '3') == kSpeedOfLight / 5020.5e6);
  for (const char band : {'0', '1', 'C'}) CHECK(plan.frequency_hz(System::kLeo, band) == 0.0);
  CHECK(plan.frequency_hz(System::kLeo, '2') == 1227.60e6);
  for (const System system : {System::kGps, System::kGalileo, System::kBeidou}) {
    for (char band = '0'; band <= '9'; ++band) {
      CHECK(plan.frequency_hz(system, band) == frequency_hz(system, band));
    }
  }
  CHECK_FALSE(plan == BandPlan());
}

TEST_CASE("Any digit may be a band of a LEO satellite", "[band_plan]") {
  for (char band = '1'; band <= '9'; ++band) CHECK(is_band_of(System::kLeo, band));
  for (const char band : {'\0', '0', ':', 'C'}) CHECK_FALSE(is_band_of(System::kLeo, band));
  CHECK(is_band_of(System::kGps, '5'));
  CHECK_FALSE(is_band_of(System::kGps, '9'));
}

}  // namespace leonav
