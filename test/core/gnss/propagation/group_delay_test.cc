#include "core/gnss/propagation/group_delay.h"

#include "support/catch.h"

namespace leonav {
namespace {

constexpr double kNs = 1e-9;
constexpr double c = kSpeedOfLight;

SignalCode code(const char* text) { return *signal_from_string(text); }

Ephemeris with(System system, NavigationMessage message, double first_s, double second_s) {
  Ephemeris e;
  e.satellite = {system, 1};
  e.message = message;
  e.group_delay_s = {first_s, second_s};
  return e;
}

const Ephemeris kGps = with(System::kGps, NavigationMessage::kGpsLnav, 5 * kNs, 0);
const Ephemeris kInav = with(System::kGalileo, NavigationMessage::kGalileoInav, 3 * kNs, 4 * kNs);
const Ephemeris kFnav = with(System::kGalileo, NavigationMessage::kGalileoFnav, 3 * kNs, 0);
const Ephemeris kD1 = with(System::kBeidou, NavigationMessage::kBeidouD1, 12 * kNs, 7 * kNs);

}  // namespace

// IS-GPS-200 20.3.3.3.3.2: (dt)_L1 = dt - T_GD, (dt)_L2 = dt - (77/60)^2 T_GD.
TEST_CASE("GPS single signals follow IS-GPS-200", "[group_delay]") {
  CHECK(group_delay(kGps, code("1C")).delay_m == Approx(c * 5 * kNs));
  CHECK(group_delay(kGps, code("2W")).delay_m == Approx(c * 5 * kNs * 77 * 77 / 3600));
  CHECK(group_delay(kGps, code("2W")).sigma_m < 0.5);
  CHECK(group_delay(kGps, code("5Q")).delay_m == 0.0);
  CHECK(group_delay(kGps, code("5Q")).sigma_m >= 1.0);  // LNAV does not tell L5's
}

TEST_CASE("The pair that the clock refers to has no delay", "[group_delay]") {
  CHECK(std::abs(group_delay(kGps, code("1W"), code("2W")).delay_m) < 1e-12);
  CHECK(group_delay(kGps, code("1W"), code("2W")).sigma_m < 0.01);
  CHECK(std::abs(group_delay(kInav, code("1C"), code("7Q")).delay_m) < 1e-12);
  CHECK(std::abs(group_delay(kFnav, code("1C"), code("5Q")).delay_m) < 1e-12);
  CHECK(group_delay(kFnav, code("1C"), code("5Q")).sigma_m < 0.01);
  CHECK(group_delay(kD1, code("6I")).delay_m == 0.0);
}

// Galileo OS-SIS-ICD 5.1.5: BGD(f1, f2) = (TR1 - TR2) / (1 - (f1/f2)^2).
TEST_CASE("Galileo's delays reproduce both BGDs", "[group_delay]") {
  const double bgd_a = 3 * kNs, bgd_b = 4 * kNs;
  const auto seconds = [&](const Ephemeris& e, const char* signal) {
    return group_delay(e, code(signal)).delay_m / c;
  };
  const double gamma_a = 154.0 * 154 / (115 * 115), gamma_b = 154.0 * 154 / (118 * 118);
  CHECK((seconds(kInav, "1C") - seconds(kInav, "5Q")) / (1 - gamma_a) == Approx(bgd_a));
  CHECK((seconds(kInav, "1C") - seconds(kInav, "7Q")) / (1 - gamma_b) == Approx(bgd_b));
  CHECK((seconds(kFnav, "1C") - seconds(kFnav, "5Q")) / (1 - gamma_a) == Approx(bgd_a));
  CHECK(seconds(kInav, "1C") == Approx(bgd_b));
  CHECK(seconds(kFnav, "1C") == Approx(bgd_a));
  // The default pair E1/E5a with the I/NAV clock: BGD_b - BGD_a, 0.3 m here and not to be left out.
  CHECK(group_delay(kInav, code("1C"), code("5Q")).delay_m == Approx(c * (bgd_b - bgd_a)));
  CHECK(group_delay(kInav, code("1C"), code("5Q")).sigma_m < 0.3);
  CHECK(group_delay(kInav, code("6C")).sigma_m >= 1.0);
  CHECK(group_delay(kFnav, code("7Q")).sigma_m >= 1.0);
}

// BDS-SIS-ICD-B1I 5.2.4.10 and BDS-SIS-ICD-B3I 7.5: B1I/B3I from TGD1, f1^2/(f1^2 - f3^2).
TEST_CASE("BeiDou's delays are against B3I", "[group_delay]") {
  CHECK(group_delay(kD1, code("2I")).delay_m == Approx(c * 12 * kNs));
  CHECK(group_delay(kD1, code("7I")).delay_m == Approx(c * 7 * kNs));
  const double f1 = 1561.098, f3 = 1268.52;
  CHECK(group_delay(kD1, code("2I"), code("6I")).delay_m ==
        Approx(c * 12 * kNs * f1 * f1 / (f1 * f1 - f3 * f3)));
  CHECK(group_delay(kD1, code("2I"), code("6I")).sigma_m < 1.0);
  CHECK(group_delay(kD1, code("5P")).sigma_m >= 1.0);
  CHECK(group_delay(kD1, code("1P")).sigma_m >= 1.0);
  CHECK(group_delay(kD1, code("7D")).delay_m == 0.0);  // B2b is not B2I
}

TEST_CASE("What is no signal or no pair has a large sigma", "[group_delay]") {
  CHECK(group_delay(kGps, code("7Q")).sigma_m == kUnknownGroupDelaySigma);
  CHECK(group_delay(kGps, SignalCode{}).sigma_m == kUnknownGroupDelaySigma);
  CHECK(group_delay(kGps, code("1C"), code("1W")).sigma_m == kUnknownGroupDelaySigma);
  CHECK(group_delay(kGps, code("1C"), code("8Q")).sigma_m == kUnknownGroupDelaySigma);
}

TEST_CASE("LEO satellites have none", "[group_delay]") {
  const Ephemeris leo = with(System::kLeo, NavigationMessage::kGpsLnav, 5 * kNs, 0);
  CHECK(group_delay(leo, code("1C")).delay_m == 0.0);
  CHECK(group_delay(leo, code("1C"), code("2W")).delay_m == 0.0);
  CHECK(precise_group_delay(System::kLeo, nullptr, code("1C"), code("2W")).delay_m == 0.0);
}

TEST_CASE("Precise clocks refer to the pair of their product", "[group_delay]") {
  CHECK(precise_group_delay(System::kGps, nullptr, code("1C"), code("2W")).delay_m == 0.0);
  CHECK(precise_group_delay(System::kGps, nullptr, code("1C"), code("2W")).sigma_m < 1.0);
  CHECK(precise_group_delay(System::kGps, nullptr, code("1C")).sigma_m == kUnknownGroupDelaySigma);
  // The same pair as the message's: the same delay.
  CHECK(precise_group_delay(System::kGps, &kGps, code("1C")).delay_m ==
        Approx(group_delay(kGps, code("1C")).delay_m));
  // Galileo's E1/E5a clock serves E1 like F/NAV's, whichever message told the BGD.
  CHECK(precise_group_delay(System::kGalileo, &kInav, code("1C")).delay_m ==
        Approx(group_delay(kFnav, code("1C")).delay_m));
  // BeiDou's product clock is the B1I/B3I pair's: B3I is then off by that pair's delay.
  CHECK(precise_group_delay(System::kBeidou, &kD1, code("6I")).delay_m ==
        Approx(-group_delay(kD1, code("2I"), code("6I")).delay_m));
  CHECK(precise_group_delay(System::kGalileo, &kGps, code("1C")).sigma_m ==
        kUnknownGroupDelaySigma);
}

}  // namespace leonav
