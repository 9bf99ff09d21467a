// Which delay each code gets with which clock: the table of docs/models/propagation.md.
#include <cmath>
#include <memory>

#include "core/gnss/preprocessing/internal/code_correction.h"
#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kNs = 1e-9 * kSpeedOfLight;  // m
const GpsTime kTime = GpsTime::from_week_and_tow(2381, 1000.0);

SignalCode code(const char* text) {
  return *text == '\0' ? SignalCode() : *signal_from_string(text);
}

Ephemeris with(System system, NavigationMessage message, double first_ns, double second_ns) {
  Ephemeris e;
  e.satellite = {system, 30};
  e.message = message;
  e.group_delay_s = {first_ns * 1e-9, second_ns * 1e-9};
  return e;
}

const Ephemeris kLnav = with(System::kGps, NavigationMessage::kGpsLnav, 5.0, 0.0);
const Ephemeris kInav = with(System::kGalileo, NavigationMessage::kGalileoInav, 3.0, 4.0);
const Ephemeris kD1 = with(System::kBeidou, NavigationMessage::kBeidouD1, 12.0, 7.0);

enum class Clock { kBroadcast, kPrecise };

// Sources of delays besides the broadcast elements.
struct Sources {
  const Ephemeris* broadcast = nullptr;
  bool cnav = false;
  bool product = false;
};

SignalBias bias_of(System system, const char* text, BiasKind kind, double metres) {
  return {{system, 30}, code(text), kind, kTime, metres, {}, {}};
}

// CNAV and B-CNAV: values of a metre and fractions, different for each code.
void add_cnav(SignalBiasStore* store) {
  const auto add = [&](System system, const char* text, double metres) {
    REQUIRE(store->add(bias_of(system, text, BiasKind::kBroadcastCode, metres)));
  };
  add(System::kGps, "1W", 1.5);
  add(System::kGps, "2W", 2.47);
  add(System::kGps, "1C", 1.7);
  add(System::kGps, "2L", 2.6);
  add(System::kGps, "5Q", -0.6);
  add(System::kBeidou, "1P", 3.8);
  add(System::kBeidou, "5P", -1.2);
}

void add_product(SignalBiasStore* store) {
  const auto add = [&](System system, const char* text, double metres) {
    REQUIRE(store->add(bias_of(system, text, BiasKind::kCode, metres)));
  };
  for (const auto& [text, metres] :
       {std::pair("1C", 0.31), {"1W", 0.22}, {"2W", 0.33}, {"2L", 0.44}, {"5Q", 0.55}})
    add(System::kGps, text, metres);
  for (const auto& [text, metres] :
       {std::pair("1C", -0.1), {"5Q", -0.2}, {"7Q", -0.3}, {"8Q", -0.4}, {"6C", -0.5}})
    add(System::kGalileo, text, metres);
  for (const auto& [text, metres] :
       {std::pair("2I", 1.1), {"6I", 1.2}, {"1P", 1.3}, {"5P", 1.4}, {"7D", 1.5}})
    add(System::kBeidou, text, metres);
}

// What code_measurement() takes from the code, and the 1 sigma that this adds.
GroupDelay delay_of(System system, const char* first, const char* second, Clock clock,
                    const Sources& sources) {
  static const GnssConfig config = default_gnss_config();
  static const KlobucharModel klobuchar;
  auto store = std::make_unique<SignalBiasStore>();
  if (sources.cnav) add_cnav(store.get());
  if (sources.product) add_product(store.get());
  const auto measure = [&](const SignalBiasStore* biases, const Ephemeris* broadcast) {
    DelayContext context = delay_context(config, klobuchar, kTime, Eigen::Vector3d::Zero());
    context.signal_biases = biases;
    SatelliteInView view;
    view.satellite = {system, 30};
    view.source = clock == Clock::kPrecise ? OrbitSource::kPrecise : OrbitSource::kBroadcast;
    view.at_antenna = true;
    SignalObservation a, b;
    a.satellite = b.satellite = view.satellite;
    a.code = code(first);
    b.code = code(second);
    a.pseudorange_m = b.pseudorange_m = 2.2e7;
    return code_measurement(context, a, b.code.is_set() ? &b : nullptr, broadcast, 1, &view);
  };
  // All other corrections are the same for a code whose delay is exactly zero and known.
  SignalBiasStore zero;
  REQUIRE(zero.add(bias_of(system, first, BiasKind::kCode, 0.0)));
  if (*second != '\0') REQUIRE(zero.add(bias_of(system, second, BiasKind::kCode, 0.0)));
  const Measurement without = measure(&zero, nullptr);
  const auto of_zero = zero.code_delay({system, 30}, kTime, code(first), code(second));
  const Measurement with_delay = measure(store.get(), sources.broadcast);
  const double variance =
      std::pow(with_delay.sigma, 2) - std::pow(without.sigma, 2) + std::pow(of_zero->sigma_m, 2);
  return {without.value - with_delay.value, std::sqrt(std::max(0.0, variance))};
}

double frequency(System system, const char* text) { return frequency_hz(system, text[0]); }

// The combination f1^2 d1 - f2^2 d2 over the difference of the squares.
double pair_of(System system, const char* first, double d1, const char* second, double d2) {
  const double a = std::pow(frequency(system, first), 2),
               b = std::pow(frequency(system, second), 2);
  return (a * d1 - b * d2) / (a - b);
}

void check(const GroupDelay& delay, double expected_m, double sigma_m) {
  CHECK(delay.delay_m == Approx(expected_m).margin(1e-7));
  CHECK(delay.sigma_m == Approx(sigma_m).margin(0.01));
}

}  // namespace

TEST_CASE("GPS: C/A, P(Y), L2C and L5 against the broadcast clock") {
  const auto lnav = [](const char* a, const char* b) {
    return delay_of(System::kGps, a, b, Clock::kBroadcast, {.broadcast = &kLnav});
  };
  const auto cnav = [](const char* a, const char* b) {
    return delay_of(System::kGps, a, b, Clock::kBroadcast, {.broadcast = &kLnav, .cnav = true});
  };
  const double gamma = 77.0 * 77.0 / 3600.0;
  check(lnav("1C", ""), 5.0 * kNs, std::hypot(0.15, 0.35));
  check(lnav("1W", ""), 5.0 * kNs, 0.15);
  check(lnav("2L", ""), gamma * 5.0 * kNs, std::hypot(0.15 * gamma, 0.35));
  check(lnav("5Q", ""), 0.0, 1.2);
  check(cnav("1C", ""), 1.7, 0.15);
  check(cnav("1W", ""), 5.0 * kNs, 0.15);  // LNAV's, which is as good
  check(cnav("2L", ""), 2.6, 0.15);
  check(cnav("5Q", ""), -0.6, 0.15);
  check(cnav("1W", "2W"), 0.0, 0.0);  // the clock's own pair
  check(cnav("1C", "2W"), pair_of(System::kGps, "1C", 1.7, "2W", 2.47), 0.447);
  check(cnav("1C", "5Q"), pair_of(System::kGps, "1C", 1.7, "5Q", -0.6), 0.388);
  CHECK(lnav("1C", "5Q").sigma_m > 1.5);
}

TEST_CASE("GPS: the same codes against a precise clock") {
  const auto of = [](const char* a, const char* b, const Sources& sources) {
    return delay_of(System::kGps, a, b, Clock::kPrecise, sources);
  };
  const Sources nothing, lnav = {.broadcast = &kLnav}, cnav = {.broadcast = &kLnav, .cnav = true},
                         product = {.broadcast = &kLnav, .cnav = true, .product = true};
  check(of("1C", "", product), 0.31, 0.06);
  check(of("1W", "2W", product), pair_of(System::kGps, "1W", 0.22, "2W", 0.33), 0.179);
  check(of("2L", "", product), 0.44, 0.06);
  check(of("1C", "5Q", product), pair_of(System::kGps, "1C", 0.31, "5Q", 0.55), 0.155);
  // Without the product's biases: CNAV refers to the same pair.
  check(of("1C", "", cnav), 1.7, 0.15);
  check(of("5Q", "", cnav), -0.6, 0.15);
  check(of("1C", "5Q", {.cnav = true}), pair_of(System::kGps, "1C", 1.7, "5Q", -0.6), 0.388);
  check(of("1W", "2W", cnav), 0.0, 0.0);
  check(of("1C", "", lnav), 5.0 * kNs, std::hypot(0.15, 0.35));
  check(of("1W", "2W", nothing), 0.0, 0.0);
  check(of("5Q", "", nothing), 0.0, kUnknownGroupDelaySigma);
}

TEST_CASE("Galileo: E1, E5a, E5b, E5 and E6 with each clock") {
  const Sources inav = {.broadcast = &kInav}, product = {.broadcast = &kInav, .product = true};
  const auto of = [](const char* a, const char* b, Clock clock, const Sources& sources) {
    return delay_of(System::kGalileo, a, b, clock, sources);
  };
  const double gamma_a = std::pow(154.0 / 115.0, 2), gamma_b = std::pow(154.0 / 118.0, 2);
  check(of("1C", "", Clock::kBroadcast, inav), 4.0 * kNs, 0.15);
  check(of("7Q", "", Clock::kBroadcast, inav), gamma_b * 4.0 * kNs, gamma_b * 0.15);
  check(of("5Q", "", Clock::kBroadcast, inav), (4.0 + (gamma_a - 1.0) * 3.0) * kNs,
        0.15 * std::hypot(1.0, gamma_a - 1.0));
  check(of("1C", "5Q", Clock::kBroadcast, inav), (4.0 - 3.0) * kNs, 0.15 * std::sqrt(2.0));
  CHECK(of("8Q", "", Clock::kBroadcast, inav).sigma_m > 1.2);
  check(of("1C", "5Q", Clock::kPrecise, inav), 0.0, 0.0);
  const double e1 = -0.1;
  check(of("1C", "", Clock::kPrecise, product), e1, 0.06);
  check(of("8Q", "", Clock::kPrecise, product), -0.4, 0.06);
  check(of("6C", "", Clock::kPrecise, product), -0.5, 0.06);
  check(of("1C", "7Q", Clock::kPrecise, product), pair_of(System::kGalileo, "1C", e1, "7Q", -0.3),
        0.06 * std::hypot(2.422, 1.422));
}

TEST_CASE("BeiDou: B1I, B3I, B1C, B2a and B2b with each clock") {
  const Sources d1 = {.broadcast = &kD1}, cnav = {.broadcast = &kD1, .cnav = true},
                product = {.broadcast = &kD1, .cnav = true, .product = true};
  const auto of = [](const char* a, const char* b, Clock clock, const Sources& sources) {
    return delay_of(System::kBeidou, a, b, clock, sources);
  };
  check(of("2I", "", Clock::kBroadcast, cnav), 12.0 * kNs, 0.15);
  check(of("6I", "", Clock::kBroadcast, cnav), 0.0, 0.0);
  check(of("7I", "", Clock::kBroadcast, cnav), 7.0 * kNs, 0.15);
  check(of("1P", "", Clock::kBroadcast, cnav), 3.8, 0.15);
  check(of("5P", "", Clock::kBroadcast, cnav), -1.2, 0.15);
  check(of("5P", "", Clock::kBroadcast, d1), 0.0, 2.4);
  check(of("7D", "", Clock::kBroadcast, cnav), 0.0, 2.4);  // B2b's is in B-CNAV3
  check(of("1P", "5P", Clock::kBroadcast, cnav), pair_of(System::kBeidou, "1P", 3.8, "5P", -1.2),
        0.388);
  // B-CNAV gives one signal of the pair, D1 the other.
  const double b1 = 12.0 * kNs;
  check(of("2I", "5P", Clock::kBroadcast, cnav), pair_of(System::kBeidou, "2I", b1, "5P", -1.2),
        0.15 * std::hypot(2.314, 1.314));

  check(of("2I", "6I", Clock::kPrecise, cnav), 0.0, 0.0);
  // Against B1I and B3I: the delay against B3I minus that of their pair.
  const double reference = pair_of(System::kBeidou, "2I", b1, "6I", 0.0);
  check(of("1P", "5P", Clock::kPrecise, cnav),
        pair_of(System::kBeidou, "1P", 3.8, "5P", -1.2) - reference,
        std::hypot(0.388, 0.15 * 2.944));
  check(of("1P", "", Clock::kPrecise, product), 1.3, 0.06);
  check(of("5P", "", Clock::kPrecise, product), 1.4, 0.06);
  check(of("7D", "", Clock::kPrecise, product), 1.5, 0.06);
  check(of("2I", "5P", Clock::kPrecise, product), pair_of(System::kBeidou, "2I", 1.1, "5P", 1.4),
        0.06 * std::hypot(2.314, 1.314));
}
