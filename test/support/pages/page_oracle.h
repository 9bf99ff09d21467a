// Values of corrections as test/oracle/correction_pages.py prints them, and ours in the same form.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "core/gnss/orbits/corrected_state.h"
#include "core/gnss/signals/signal.h"
#include "drivers/ssr/accuracy.h"
#include "drivers/ssr/ssr_correction.h"
#include "support/temporary_file.h"

namespace leonav::test {

// Kind of the line (O, C, B, P, S), second of the week, satellite, signal or nothing.
using PageValueKey = std::tuple<char, long, std::string, std::string>;
using PageValues = std::map<PageValueKey, std::vector<double>>;

inline std::string page_oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/correction_pages.py' ";
}

inline bool have_page_oracle() {
  if (std::system((page_oracle() + "--have 2>/dev/null").c_str()) == 0) return true;
  std::cout << "SKIPPED (optional): no Python with cssrlib (LEONAV_PYTHON names another)\n";
  return false;
}

// Runs the oracle over files of pages and of ephemerides; empty where it fails.
inline PageValues oracle_values(const std::string& service, const std::string& pages,
                                const std::string& navigation) {
  const TemporaryFile output("values.txt", "");
  const std::string command =
      page_oracle() + service + " '" + pages + "' '" + navigation + "' >'" + output.path() + "'";
  PageValues values;
  if (std::system(command.c_str()) != 0) return values;
  std::ifstream file(output.path());
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    PageValueKey key;
    words >> std::get<0>(key) >> std::get<1>(key) >> std::get<2>(key);
    const char kind = std::get<0>(key);
    if (kind == 'B' || kind == 'P') words >> std::get<3>(key);
    std::vector<double>& numbers = values[key];
    numbers.clear();
    for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
  }
  return values;
}

// Adds the values of a message, in the sign of SSR, biases in the sign of the service.
inline void add_values(const SsrMessage& message, PageValues* values) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const bool is_b2b = message.service == SsrService::kBeidouB2b;
  const long second = std::lround(message.time.tow_s());
  const auto issue = [](const std::optional<std::uint8_t>& value) {
    return value ? static_cast<double>(*value) : -1.0;
  };
  for (const SsrSatellite& s : message.satellites) {
    const std::string name = to_string(s.satellite);
    if (s.orbit) {
      const Eigen::Vector3d& d = s.orbit->delta_rac_m;
      const double accuracy =
          is_b2b ? ssr_accuracy_m(s.accuracy_index.value_or(0)).value_or(none) : -1.0;
      (*values)[{'O', second, name, ""}] = {static_cast<double>(s.orbit->issue),
                                            issue(s.orbit->correction_issue),
                                            d.x(),
                                            d.y(),
                                            d.z(),
                                            accuracy};
    }
    if (s.clock) {
      (*values)[{'C', second, name, ""}] = {issue(s.clock->correction_issue), s.clock->c0_m};
    }
    if (s.orbit_ends) (*values)[{'O', second, name, ""}] = {none};
    if (s.clock_ends) (*values)[{'C', second, name, ""}] = {none};
    for (const SsrBias& bias : s.code_biases) {
      (*values)[{'B', second, name, to_string(bias.code)}] = {is_b2b ? -bias.bias_m : bias.bias_m};
    }
    for (const SsrBias& bias : s.phase_biases) {
      const double wavelength = wavelength_m(s.satellite.system, bias.code.band);
      (*values)[{'P', second, name, to_string(bias.code)}] = {
          bias.bias_m / wavelength, static_cast<double>(bias.discontinuities)};
    }
  }
}

inline void add_value(const CorrectedState& state, PageValues* values) {
  (*values)[{'S', std::lround(state.time.tow_s()), to_string(state.satellite), ""}] = {
      state.p_e.x(), state.p_e.y(), state.p_e.z(), kSpeedOfLight * state.clock_s};
}

// What a comparison found of one kind of lines.
struct PageComparison {
  std::size_t same = 0, different = 0, ours_alone = 0, theirs_alone = 0;
  double position_m = 0.0, clock_m = 0.0;  // largest differences of states
  PageValueKey first_theirs, first_ours, first_different;
  std::vector<PageValueKey> theirs;  // that are theirs alone
};

// A value that is not available is equal to one that is not available, or not there.
inline PageComparison compare(char kind, const PageValues& ours, const PageValues& theirs) {
  const auto is_none = [](const std::vector<double>& numbers) {
    constexpr std::size_t kAccuracy = 5;  // whose index may say nothing
    const auto end = numbers.begin() + std::min(numbers.size(), kAccuracy);
    return std::any_of(numbers.begin(), end, [](double number) { return std::isnan(number); });
  };
  PageComparison c;
  for (const auto& [key, their] : theirs) {
    if (std::get<0>(key) != kind) continue;
    const auto our = ours.find(key);
    if (our == ours.end() || is_none(our->second)) {
      if (is_none(their)) {
        ++c.same;
      } else {
        if (c.theirs_alone++ == 0) c.first_theirs = key;
        c.theirs.push_back(key);
      }
      continue;
    }
    bool is_same = our->second.size() == their.size();
    if (is_same && kind == 'S') {
      for (std::size_t i = 0; i < 4; ++i) {
        const double difference = std::abs(our->second[i] - their[i]);
        double& largest = i < 3 ? c.position_m : c.clock_m;
        largest = std::max(largest, difference);
      }
    } else {
      for (std::size_t i = 0; is_same && i < their.size(); ++i) {
        is_same =
            our->second[i] == their[i] || (std::isnan(our->second[i]) && std::isnan(their[i]));
      }
    }
    if (is_same) {
      ++c.same;
    } else if (c.different++ == 0) {
      c.first_different = key;
    }
  }
  for (const auto& [key, our] : ours) {
    if (std::get<0>(key) != kind || is_none(our) || theirs.count(key) != 0) continue;
    if (c.ours_alone++ == 0) c.first_ours = key;
  }
  const auto text = [](const PageValueKey& k) {
    return std::to_string(std::get<1>(k)) + " " + std::get<2>(k) + " " + std::get<3>(k);
  };
  std::cout << kind << ": " << c.same << " same, " << c.different << " different ("
            << text(c.first_different) << "), " << c.ours_alone << " ours alone ("
            << text(c.first_ours) << "), " << c.theirs_alone << " theirs alone ("
            << text(c.first_theirs) << ")";
  if (kind == 'S') {
    std::cout << "; largest difference of position " << 1e3 * c.position_m << " mm, of clock "
              << 1e3 * c.clock_m << " mm";
  }
  std::cout << "\n";
  return c;
}

}  // namespace leonav::test
