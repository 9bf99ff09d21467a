#include "core/gnss/signals/signal.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("Carrier frequencies as published", "[signal]") {
  struct Row {
    System system;
    char band;
    double mhz;
  };
  // RINEX 3.04, tables 4, 6 and 9.
  for (const Row& row : {Row{System::kGps, '1', 1575.42}, Row{System::kGps, '2', 1227.60},
                         Row{System::kGps, '5', 1176.45}, Row{System::kGalileo, '1', 1575.42},
                         Row{System::kGalileo, '5', 1176.45}, Row{System::kGalileo, '7', 1207.140},
                         Row{System::kGalileo, '8', 1191.795}, Row{System::kGalileo, '6', 1278.75},
                         Row{System::kBeidou, '2', 1561.098}, Row{System::kBeidou, '1', 1575.42},
                         Row{System::kBeidou, '5', 1176.45}, Row{System::kBeidou, '7', 1207.140},
                         Row{System::kBeidou, '8', 1191.795}, Row{System::kBeidou, '6', 1268.52}}) {
    INFO(to_string(row.system) << " band " << row.band);
    CHECK(frequency_hz(row.system, row.band) == Approx(row.mhz * 1e6).epsilon(1e-14));
    CHECK(wavelength_m(row.system, row.band) * row.mhz * 1e6 ==
          Approx(kSpeedOfLight).epsilon(1e-14));
  }
}

TEST_CASE("A band that a system does not have has no frequency", "[signal]") {
  for (const System system : kSystems) {
    for (const char band : {'\0', '0', '3', '4', '9', 'C', ' '}) {
      CHECK(frequency_hz(system, band) == 0.0);
      CHECK(wavelength_m(system, band) == 0.0);
    }
  }
  CHECK(frequency_hz(System::kGps, '7') == 0.0);
  CHECK(frequency_hz(System::kGalileo, '2') == 0.0);
  // Those of LEO satellites are not fixed.
  CHECK(frequency_hz(System::kLeo, '1') == 0.0);
  CHECK(frequency_hz(static_cast<System>(99), '1') == 0.0);
}

TEST_CASE("Signal codes are a digit and a capital", "[signal]") {
  CHECK(signal_from_string("2W") == SignalCode{'2', 'W'});
  CHECK(to_string(SignalCode{'5', 'Q'}) == "5Q");
  CHECK(to_string(SignalCode{}).empty());
  for (const std::string_view code : {"", "1", "1c", "C1", "C1C", "0C", "1 ", "1\xc3"}) {
    INFO(code);
    CHECK_FALSE(signal_from_string(code).has_value());
  }
}

}  // namespace leonav
