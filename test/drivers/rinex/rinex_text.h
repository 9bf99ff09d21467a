// RINEX text put together for tests.
#pragma once
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "core/base/calendar.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/rinex/observation_reader.h"
#include "support/temporary_file.h"

namespace leonav::test {

inline std::string header_line(std::string content, const std::string& label) {
  content.resize(60, ' ');
  return content + label + "\n";
}

// One field: F14.3, loss-of-lock digit, strength digit.
inline std::string field(double value, char lock = ' ', char strength = ' ') {
  char text[32];
  std::snprintf(text, sizeof text, "%14.3f%c%c", value, lock, strength);
  return text;
}
inline std::string blank_field() { return std::string(16, ' '); }

inline std::string header_3(const std::string& version, const std::string& types,
                            const std::string& time_system = "GPS") {
  return header_line("     " + version + "           OBSERVATION DATA    M",
                     "RINEX VERSION / TYPE") +
         header_line("        0.0000        0.0000        0.0000", "APPROX POSITION XYZ") + types +
         header_line("  2024    05    06    07    08    9.0000000     " + time_system,
                     "TIME OF FIRST OBS") +
         header_line("", "END OF HEADER");
}

inline std::string types_3(const std::string& content) {
  return header_line(content, "SYS / # / OBS TYPES");
}

inline std::string epoch_3(const std::string& second, int flag, int count) {
  char text[64];
  std::snprintf(text, sizeof text, "> 2024 05 06 07 08%11s  %d%3d\n", second.c_str(), flag, count);
  return text;
}

struct Observations {
  std::vector<RawEpoch> epochs;
  ReadCounts counts;
  CapacityLosses losses;
};

inline Observations read_text(const std::string& text) {
  const TemporaryFile file("test.obs", text);
  ObservationReader reader(file.path());
  Observations result;
  RawEpoch epoch;
  while (reader.next(&epoch)) result.epochs.push_back(epoch);
  result.counts = reader.counts();
  result.losses = reader.losses();
  return result;
}

inline const SignalObservation* find(const RawEpoch& epoch, const std::string& satellite,
                                     const std::string& code) {
  for (const SignalObservation& o : epoch.observations) {
    if (to_string(o.satellite) == satellite && to_string(o.code) == code) return &o;
  }
  return nullptr;
}

// A plausible record of a navigation file in Kepler form; `values` replaces single fields by their
// place (0 is af0).
inline std::string record_3(const std::string& head, std::vector<std::pair<int, double>> values,
                            const char* exponent = "e") {
  double f[31] = {1e-4, 1e-12, 0,    85,    12.5, 4e-9, 0.5, -1e-6, 1e-2,  8e-6, 5153.7,
                  0,    1e-8,  -2.9, 2e-8,  0.96, 238., 0.7, -8e-9, 3e-10, 1,    2313,
                  0,    2.0,   0,    -1e-8, 85,   0,    4,   0,     0};
  for (const auto& [place, value] : values) f[place] = value;
  std::string text = head;
  for (int i = 0; i < 31; ++i) {
    if (i >= 3 && (i - 3) % 4 == 0) text += "\n    ";
    char field[32];
    std::snprintf(field, sizeof field, "%19.12e", f[i]);
    text += field;
  }
  std::replace(text.begin(), text.end(), 'e', exponent[0]);
  return text + "\n";
}

// When most of the records are valid: tow 115200, week 2313.
inline const GpsTime kMonday = from_calendar({2024, 5, 6, 8, 0, 0.0});

inline NavigationFile read_navigation_text(const std::string& text) {
  const TemporaryFile file("test.nav", text);
  return read_navigation(file.path());
}

}  // namespace leonav::test
