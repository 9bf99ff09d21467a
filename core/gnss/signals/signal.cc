#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

// Every carrier of these systems is a multiple of this fundamental frequency, 10.23 MHz.
constexpr double kFundamental = 10.23e6;

// GPS carriers: IS-GPS-200 3.3.1.1, IS-GPS-705 3.3.1.1.
double gps_multiple(char band) {
  switch (band) {
    case '1':
      return 154.0;
    case '2':
      return 120.0;
    case '5':
      return 115.0;
    default:
      return 0.0;
  }
}

// Galileo carriers: OS-SIS-ICD 2.1, table 2: E1, E5a, E5b, E5 (AltBOC), E6.
double galileo_multiple(char band) {
  switch (band) {
    case '1':
      return 154.0;
    case '5':
      return 115.0;
    case '7':
      return 118.0;
    case '8':
      return 116.5;
    case '6':
      return 125.0;
    default:
      return 0.0;
  }
}

// BeiDou carriers: BDS-SIS-ICD-B1I 3.0, -B1C 1.0, -B2a 1.0, -B2b 1.0, -B3I 1.0; the bands are those
// of RINEX 3.04, table A9.
double beidou_multiple(char band) {
  switch (band) {
    case '1':
      return 154.0;
    case '2':
      return 152.6;
    case '5':
      return 115.0;
    case '6':
      return 124.0;
    case '7':
      return 118.0;
    case '8':
      return 116.5;
    default:
      return 0.0;
  }
}

}  // namespace

std::optional<SignalCode> signal_from_string(std::string_view code) {
  if (code.size() != 2) return std::nullopt;
  if (code[0] < '1' || code[0] > '9' || code[1] < 'A' || code[1] > 'Z') return std::nullopt;
  return SignalCode{code[0], code[1]};
}

std::string to_string(SignalCode code) {
  if (!code.is_set()) return "";
  return {code.band, code.attribute};
}

double frequency_hz(System system, char band) {
  switch (system) {
    case System::kGps:
      return gps_multiple(band) * kFundamental;
    case System::kGalileo:
      return galileo_multiple(band) * kFundamental;
    case System::kBeidou:
      return beidou_multiple(band) * kFundamental;
    case System::kLeo:
      break;
  }
  return 0.0;
}

double wavelength_m(System system, char band) {
  const double frequency = frequency_hz(system, band);
  return frequency > 0.0 ? kSpeedOfLight / frequency : 0.0;
}

}  // namespace leonav
