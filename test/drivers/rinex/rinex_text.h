// RINEX text put together for tests.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

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

}  // namespace leonav::test
