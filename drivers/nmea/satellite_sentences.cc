#include "drivers/nmea/satellite_sentences.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/angle.h"
#include "drivers/nmea/fields.h"
#include "drivers/nmea/fix_quality.h"
#include "drivers/nmea/sentence.h"

namespace leonav {
namespace {

constexpr std::size_t kPerGsa = 12, kPerGsv = 4;
constexpr std::size_t kMostInView = 36;  // nine GSV of a system: their number has one digit

struct NmeaSystem {
  System system;
  const char* identifier;
  const char* talker;
  std::uint16_t highest;
};
constexpr std::array<NmeaSystem, 3> kNmeaSystems = {{{System::kGps, "1", "GP", 32},
                                                     {System::kGalileo, "3", "GA", 36},
                                                     {System::kBeidou, "4", "GB", 63}}};

std::string two_digits(int value) { return (value < 10 ? "0" : "") + std::to_string(value); }

std::vector<SatelliteView> of_system(const SkyView& sky, const NmeaSystem& system, bool only_used) {
  std::vector<SatelliteView> found;
  for (const SatelliteView& one : sky.satellites) {
    const bool has_number = one.satellite.system == system.system && one.satellite.number > 0 &&
                            one.satellite.number <= system.highest;
    if (has_number && (one.is_used || !only_used)) found.push_back(one);
  }
  return found;
}

std::string dop_field(double dop) {
  const bool is_known = dop > 0.0;  // false of NaN
  return number_field(is_known ? std::min(dop, 99.99) : std::numeric_limits<double>::quiet_NaN(),
                      2);
}

// Names the satellites from `first` on, as many as one sentence has room for.
std::string gsa_sentence(char mode, const std::vector<SatelliteView>& used, std::size_t first,
                         const SkyView* sky, const NmeaSystem& system) {
  Sentence sentence(std::string(system.talker) + "GSA");
  sentence.field("A").field(std::string(1, mode));
  for (std::size_t i = first; i < first + kPerGsa; ++i) {
    sentence.field(i < used.size() ? two_digits(used[i].satellite.number) : "");
  }
  for (const double dop : {sky ? sky->pdop : 0.0, sky ? sky->hdop : 0.0, sky ? sky->vdop : 0.0}) {
    sentence.field(dop_field(dop));
  }
  return sentence.field(system.identifier).line();
}

void add_view(const SatelliteView& view, Sentence* sentence) {
  sentence->field(two_digits(view.satellite.number));
  const bool has_direction = std::isfinite(view.elevation) && std::isfinite(view.azimuth);
  if (has_direction) {
    const double degrees = std::clamp(view.elevation * kDegreesPerRadian, -90.0, 90.0);
    const int elevation = static_cast<int>(std::lround(degrees));
    const double azimuth = std::fmod(view.azimuth * kDegreesPerRadian, 360.0);
    const int bearing = static_cast<int>((std::lround(azimuth) + 360) % 360);
    sentence->field(elevation < 0 ? std::to_string(elevation) : two_digits(elevation));
    sentence->field((bearing < 100 ? "0" : "") + two_digits(bearing));
  } else {
    sentence->field("").field("");
  }
  const bool is_tracked = view.cn0_dbhz > 0.0;
  sentence->field(
      is_tracked ? two_digits(static_cast<int>(std::lround(std::min(view.cn0_dbhz, 99.0)))) : "");
}

}  // namespace

std::string gsa_sentences(const Solution& solution, const SkyView* sky) {
  const char mode = quality_of(solution, 0.0).gsa;
  std::string lines;
  const bool has_satellites =
      sky != nullptr && solution.source != Source::kNone && solution.source != Source::kInsOnly;
  for (const NmeaSystem& system : kNmeaSystems) {
    if (!has_satellites) break;
    const std::vector<SatelliteView> used = of_system(*sky, system, true);
    for (std::size_t first = 0; first < used.size(); first += kPerGsa) {
      lines += gsa_sentence(mode, used, first, sky, system);
    }
  }
  return lines.empty() ? gsa_sentence(mode, {}, 0, nullptr, kNmeaSystems[0]) : lines;
}

std::string gsv_sentences(const SkyView* sky) {
  std::string lines;
  if (sky == nullptr) return lines;
  for (const NmeaSystem& system : kNmeaSystems) {
    const std::vector<SatelliteView> all = of_system(*sky, system, false);
    const std::size_t shown = std::min(all.size(), kMostInView);
    const std::size_t total = (shown + kPerGsv - 1) / kPerGsv;
    for (std::size_t number = 0; number < total; ++number) {
      Sentence sentence(std::string(system.talker) + "GSV");
      sentence.field(std::to_string(total)).field(std::to_string(number + 1));
      sentence.field(two_digits(static_cast<int>(shown)));
      for (std::size_t i = kPerGsv * number; i < std::min(shown, kPerGsv * (number + 1)); ++i) {
        add_view(all[i], &sentence);
      }
      lines += sentence.field("0").line();  // 0: of all signals
    }
  }
  return lines;
}

}  // namespace leonav
