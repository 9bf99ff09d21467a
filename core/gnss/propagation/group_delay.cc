#include "core/gnss/propagation/group_delay.h"

#include <array>
#include <cmath>

namespace leonav {
namespace {

// Delay of one signal against the clock's reference: a linear form in the broadcast delays plus an
// unknown part. Keeping the form instead of the value lets errors of a broadcast delay cancel in a
// combination as they do in reality.
struct LinearDelay {
  std::array<double, 2> coefficient = {0.0, 0.0};  // of Ephemeris::group_delay_s
  double unknown_m = 0.0;                          // 1 sigma of the part that the form leaves out
};

// 1 sigma of a broadcast TGD or BGD: half a nanosecond, of resolution and estimation.
constexpr double kBroadcastDelaySigma = 0.15;  // m
// 1 sigma of the delay between two codes on one carrier (C/A against P, pilot against data).
constexpr double kSameCarrierSigma = 0.35;  // m (measured for C/A: 0.36 m)
// 1 sigma of the delay of a carrier that the message does not contain (measured for L5: 1.6 m in
// the pair, 1.2 m in L5).
constexpr double kUnreportedDelaySigma = 1.2;  // m

double frequency_ratio_squared(System system, char numerator, char denominator) {
  const double ratio = frequency_hz(system, numerator) / frequency_hz(system, denominator);
  return ratio * ratio;
}

// IS-GPS-200 20.3.3.3.3.2: the clock is that of the ionosphere-free L1P/L2P. L5 needs an
// inter-signal correction that LNAV does not have. It is taken as zero: over eleven satellites of
// June 2020 the C/A-L5 pair then agrees with C/A-L2P to 1.6 m rms; scaled as for L2, to 2.0 m.
LinearDelay gps_delay(SignalCode code) {
  if (code.band == '1' || code.band == '2') {
    const bool is_p_code = code.attribute == 'W' || code.attribute == 'P' || code.attribute == 'Y';
    return {{frequency_ratio_squared(System::kGps, '1', code.band), 0.0},
            is_p_code ? 0.0 : kSameCarrierSigma};
  }
  return {{0.0, 0.0}, kUnreportedDelaySigma};
}

// Galileo OS-SIS-ICD 5.1.5. The clock of F/NAV is that of E1/E5a, the clock of I/NAV that of
// E1/E5b; the other BGD then gives the delay of the other frequency against E1.
LinearDelay galileo_delay(NavigationMessage message, SignalCode code) {
  const bool fnav = message == NavigationMessage::kGalileoFnav;
  const std::size_t own = fnav ? 0 : 1;  // BGD of the clock's pair
  const std::size_t other = fnav ? 1 : 0;
  LinearDelay delay;
  delay.coefficient[own] = 1.0;  // E1
  if (code.band == '1') return delay;
  const double gamma = frequency_ratio_squared(System::kGalileo, '1', code.band);
  const char own_band = fnav ? '5' : '7';
  const char other_band = fnav ? '7' : '5';
  if (code.band == own_band) {
    delay.coefficient[own] = gamma;
  } else if (code.band == other_band && !fnav) {
    delay.coefficient[other] = gamma - 1.0;
  } else {
    // F/NAV has no BGD E5b/E1; E5 (AltBOC) and E6 have no BGD at all.
    delay.coefficient[own] = gamma;
    delay.unknown_m = code.band == '6' ? kUnknownGroupDelaySigma : kUnreportedDelaySigma;
  }
  return delay;
}

// BDS-SIS-ICD-B1I 5.2.4.10: the clock is that of B3I; TGD1 is the delay of B1I, TGD2 that of B2I.
// D1 and D2 contain neither those of B1C and B2a (their TGDs are in B-CNAV1 and 2) nor that of
// BDS-3's B2b. B1C is taken as B1I, 14 MHz away; B2a and B2b as zero, that is as B3I.
LinearDelay beidou_delay(SignalCode code) {
  switch (code.band) {
    case '6':
      return {};
    case '2':
      return {{1.0, 0.0}, 0.0};
    case '1':
      return {{1.0, 0.0}, kUnreportedDelaySigma};
    case '7':
      if (code.attribute == 'I' || code.attribute == 'Q' || code.attribute == 'X') {
        return {{0.0, 1.0}, 0.0};
      }
      return {{0.0, 0.0}, 2.0 * kUnreportedDelaySigma};
    default:
      return {{0.0, 0.0}, 2.0 * kUnreportedDelaySigma};
  }
}

LinearDelay signal_delay(System system, NavigationMessage message, SignalCode code) {
  switch (system) {
    case System::kGps:
      return gps_delay(code);
    case System::kGalileo:
      return galileo_delay(message, code);
    case System::kBeidou:
      return beidou_delay(code);
    case System::kLeo:
      return {};
  }
  return {{0.0, 0.0}, kUnknownGroupDelaySigma};
}

LinearDelay combine(const LinearDelay& a, double factor_a, const LinearDelay& b, double factor_b) {
  LinearDelay sum;
  for (std::size_t i = 0; i < sum.coefficient.size(); ++i) {
    sum.coefficient[i] = factor_a * a.coefficient[i] + factor_b * b.coefficient[i];
  }
  sum.unknown_m = std::hypot(factor_a * a.unknown_m, factor_b * b.unknown_m);
  return sum;
}

// Computes the form of one signal, or of the ionosphere-free pair if `second` is set. Returns false
// where the signal or pair does not exist.
bool observable_delay(System system, NavigationMessage message, SignalCode first, SignalCode second,
                      LinearDelay* delay) {
  const double f1 = frequency_hz(system, first.band);
  if (f1 <= 0.0) return false;
  *delay = signal_delay(system, message, first);
  if (!second.is_set()) return true;
  const double f2 = frequency_hz(system, second.band);
  if (f2 <= 0.0 || f1 == f2) return false;
  const double difference = f1 * f1 - f2 * f2;
  *delay = combine(*delay, f1 * f1 / difference, signal_delay(system, message, second),
                   -f2 * f2 / difference);
  return true;
}

GroupDelay evaluate(const LinearDelay& form, const std::array<double, 2>& broadcast_s) {
  GroupDelay delay;
  double variance = form.unknown_m * form.unknown_m;
  for (std::size_t i = 0; i < broadcast_s.size(); ++i) {
    delay.delay_m += kSpeedOfLight * form.coefficient[i] * broadcast_s[i];
    variance += std::pow(form.coefficient[i] * kBroadcastDelaySigma, 2);
  }
  delay.sigma_m = std::sqrt(variance);
  return delay;
}

}  // namespace

GroupDelay group_delay(const Ephemeris& ephemeris, SignalCode first, SignalCode second) {
  if (ephemeris.satellite.system == System::kLeo) return {};
  LinearDelay form;
  if (!observable_delay(ephemeris.satellite.system, ephemeris.message, first, second, &form)) {
    return {0.0, kUnknownGroupDelaySigma};
  }
  return evaluate(form, ephemeris.group_delay_s);
}

GroupDelay precise_group_delay(System system, const Ephemeris* broadcast, SignalCode first,
                               SignalCode second) {
  SignalCode reference_first, reference_second;
  switch (system) {
    case System::kGps:
      reference_first = {'1', 'W'}, reference_second = {'2', 'W'};
      break;
    case System::kGalileo:
      reference_first = {'1', 'C'}, reference_second = {'5', 'Q'};
      break;
    case System::kBeidou:
      reference_first = {'2', 'I'}, reference_second = {'6', 'I'};
      break;
    case System::kLeo:
      return {};
  }
  const bool is_reference =
      first.band == reference_first.band && second.band == reference_second.band;
  if (broadcast == nullptr || broadcast->satellite.system != system) {
    if (!is_reference) return {0.0, kUnknownGroupDelaySigma};
    return {0.0, first == reference_first ? 0.0 : kSameCarrierSigma};
  }
  LinearDelay form, reference;
  if (!observable_delay(system, broadcast->message, first, second, &form) ||
      !observable_delay(system, broadcast->message, reference_first, reference_second,
                        &reference)) {
    return {0.0, kUnknownGroupDelaySigma};
  }
  return evaluate(combine(form, 1.0, reference, -1.0), broadcast->group_delay_s);
}

}  // namespace leonav
