#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/base/angle.h"
#include "daemon/config/config_groups.h"

namespace leonav {
namespace {

// One character of each text into a fixed list; the texts must be single characters from..to.
template <typename List>
void read_letters(ConfigReader& group, const char* key, char from, char to, List* letters) {
  std::vector<std::string> texts;
  for (const char letter : *letters) texts.emplace_back(1, letter);
  const std::string allowed =
      "list of at most " + std::to_string(letters->capacity()) + ", each " + from + " to " + to;
  if (!group.list(key, &texts, allowed)) return;
  if (texts.size() > letters->capacity()) {
    group.report(key, "at most " + std::to_string(letters->capacity()) + " entries");
    return;
  }
  letters->clear();
  for (const std::string& text : texts) {
    if (text.size() != 1 || text[0] < from || text[0] > to) {
      group.report(key, "'" + text + "' is not one character from " + from + " to " + to);
    } else if (std::find(letters->begin(), letters->end(), text[0]) != letters->end()) {
      group.report(key, "'" + text + "' is given twice");
    } else {
      letters->push_back(text[0]);
    }
  }
}

void read_system(ConfigReader& group, SystemConfig* config) {
  std::string first_band(1, config->signals.first_band);
  group.text("first_band", &first_band, "1 to 9");
  if (first_band.size() != 1 || first_band[0] < '1' || first_band[0] > '9') {
    group.report("first_band", "must be one RINEX band digit, 1 to 9");
  } else {
    config->signals.first_band = first_band[0];
  }
  read_letters(group, "second_bands", '1', '9', &config->signals.second_bands);
  read_letters(group, "attributes", 'A', 'Z', &config->signals.attributes);
  group.integer("max_satellites", 0, 512, &config->max_satellites);
  group.number("code_sigma_m", {1e-3, 1e3}, &config->sigma.code_m);
  group.number("wideband_code_factor", {0.01, 10.0}, &config->sigma.wideband_code_factor);
  group.number("carrier_sigma_m", {1e-5, 10.0}, &config->sigma.carrier_m);
  group.number("doppler_sigma_m_s", {1e-4, 1e2}, &config->sigma.doppler_m_s);
}

// Signals of LEO satellites on a band without a carrier could never be used.
void check_bands(const ConfigReader& group, const BandPlan& bands,
                 const SignalPreference& signals) {
  const auto check = [&](const char* key, char band) {
    if (bands.frequency_hz(System::kLeo, band) > 0.0) return;
    group.report(key, std::string("names band ") + band +
                          ", which has no carrier: give gnss.leo_bands_mhz." + band +
                          " in MHz, or name a band that has one");
  };
  check("first_band", signals.first_band);
  for (const char band : signals.second_bands) check("second_bands", band);
}

void read_catalog(ConfigReader& group, EphemerisConfig* config) {
  constexpr Bounds kAge = {1.0, 7.0 * 86400.0};
  group.boolean("use_precise", &config->use_precise);
  group.number("max_age_gps_s", kAge, &config->max_age_gps_s);
  group.number("max_age_galileo_s", kAge, &config->max_age_galileo_s);
  group.number("max_age_beidou_s", kAge, &config->max_age_beidou_s);
  group.number("max_age_leo_s", kAge, &config->max_age_leo_s);
  group.number("max_age_corrections_s", {1.0, 3600.0}, &config->max_age_corrections_s);
  group.number("max_orbit_gap_s", kAge, &config->max_orbit_gap_s);
  group.number("max_clock_gap_s", kAge, &config->max_clock_gap_s);
  group.boolean("galileo_prefers_fnav", &config->galileo_prefers_fnav);
}

void read_systems(ConfigReader& group, GnssConfig* config) {
  std::vector<std::string> names;
  for (const System system : kSystems) {
    if (config->systems[index_of(system)].enabled) names.emplace_back(to_string(system));
  }
  if (!group.list("systems", &names, "list of gps, galileo, beidou, leo")) return;
  if (names.empty()) group.report("systems", "name at least one of gps, galileo, beidou, leo");
  for (SystemConfig& system : config->systems) system.enabled = false;
  for (const std::string& name : names) {
    const auto system = system_from_string(name);
    if (!system) {
      group.report("systems", "'" + name + "' is not one of gps, galileo, beidou, leo");
      continue;
    }
    SystemConfig& chosen = config->systems[index_of(*system)];
    if (chosen.enabled) group.report("systems", "'" + name + "' is given twice");
    chosen.enabled = true;
  }
}

}  // namespace

void read_leo_bands(ConfigReader& group, const char* key, BandPlan* bands) {
  constexpr double kMegahertz = 1e6;
  group.group(key, [bands](ConfigReader& reader) {
    std::array<std::string, BandPlan::kBands> names;
    for (std::size_t i = 0; i < BandPlan::kBands; ++i) {
      const char band = static_cast<char>(BandPlan::kFirstBand + i);
      names[i] = std::string(1, band);
      const double before = bands->frequency_hz(System::kLeo, band);
      std::optional<double> mhz;
      if (before > 0.0) mhz = before / kMegahertz;
      reader.number(names[i].c_str(),
                    {BandPlan::kLowest_hz / kMegahertz, BandPlan::kHighest_hz / kMegahertz}, &mhz);
      // A tenth of a hertz is far finer than any interface document.
      const double hz = mhz ? std::round(*mhz * kMegahertz * 10.0) / 10.0 : 0.0;
      bands->set_leo(band, hz);
      for (char other = BandPlan::kFirstBand; hz > 0.0 && other < band; ++other) {
        if (bands->frequency_hz(System::kLeo, other) != hz) continue;
        std::array<char, 96> why{};  // gcc 12 reports a false error in a sum of texts here
        std::snprintf(why.data(), why.size(),
                      "is also the carrier of band %c; give it to one band and ~ to the other",
                      other);
        reader.report(names[i].c_str(), why.data());
      }
    }
  });
}

void read_gnss(ConfigReader& group, GnssConfig* config) {
  read_systems(group, config);
  read_leo_bands(group, "leo_bands_mhz", &config->bands);
  group.number("elevation_mask_deg", {-90.0, 90.0}, &config->elevation_mask, kDegree);
  group.number("cn0_mask_dbhz", {0.0, 60.0}, &config->cn0_mask_dbhz);
  group.choice<CodeCombination>("code_combination",
                                {{"ionosphere_free", CodeCombination::kIonosphereFree},
                                 {"single_frequency", CodeCombination::kSingleFrequency},
                                 {"automatic", CodeCombination::kAutomatic}},
                                &config->code_combination);
  group.choice<WeightModel>("weight_model",
                            {{"elevation", WeightModel::kElevation},
                             {"cn0", WeightModel::kCn0},
                             {"sine", WeightModel::kSine}},
                            &config->weight_model);
  group.number("cn0_reference_dbhz", {10.0, 70.0}, &config->cn0_reference_dbhz);
  group.choice<bool>("atmosphere", {{"standard", true}, {"none", false}}, &config->has_atmosphere);
  group.number("ionosphere_model_error", {0.0, 10.0}, &config->ionosphere_model_error);
  group.number("troposphere_model_error_m", {0.0, 10.0}, &config->troposphere_model_error_m);
  group.choice<AttitudeLaw>(
      "leo_attitude",
      {{"orbit_normal", AttitudeLaw::kOrbitNormal}, {"yaw_steering", AttitudeLaw::kYawSteering}},
      &config->leo_attitude);
  read_ground(group, config);
  group.group("ephemerides", [&](ConfigReader& ephemeris_store) {
    read_catalog(ephemeris_store, &config->ephemeris_store);
  });
  for (const System system : kSystems) {
    const std::string name(to_string(system));
    group.group(name.c_str(), [&](ConfigReader& reader) {
      SystemConfig& chosen = config->systems[index_of(system)];
      read_system(reader, &chosen);
      if (system == System::kLeo && chosen.enabled)
        check_bands(reader, config->bands, chosen.signals);
    });
  }
}

}  // namespace leonav
