// This unit counts how often errors exceed the protection levels of a solution, and alert limits.
//
// The regions are those of the Stanford diagram (Tossaint, Samson, Toran, Ventura-Traveset,
// Hernandez-Pajares, Juan, Sanz, Ramos-Bosch, "The Stanford - ESA integrity diagram", Navigation
// 54(2), 2007). Counts of several runs can be added up.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/evaluate/errors.h"

namespace leonav {

// An error, as absolute value, with the level that should bound it and its stated sigma. m or rad.
struct LevelSample {
  GpsTime time;
  double error = 0.0, level = 0.0;
  std::optional<double> sigma = {};  // horizontal: the root of the sum of both variances

  bool is_misleading() const { return error > level; }
};

// The regions for one alert limit. The level is at most the limit in the first three, in which the
// system is available.
struct AlertLimitCounts {
  double limit_m = 0.0;
  std::size_t nominal = 0;     // the error is within the level
  std::size_t misleading = 0;  // beyond the level, within the limit
  std::size_t hazardous = 0;   // beyond the limit
  std::size_t unavailable = 0;
  std::size_t unavailable_misleading = 0;  // and the error is beyond the level
  std::size_t hazardous_blocks = 0;        // blocks with a hazardous epoch

  std::size_t available() const { return nominal + misleading + hazardous; }
};

// Epochs, and blocks, whose (largest) error is so many tenths of its sigma, rounded down.
struct MultipleCounts {
  std::size_t epochs = 0, blocks = 0;

  bool operator==(const MultipleCounts&) const = default;
};

// The counts of one quantity.
struct IntegrityCounts {
  std::size_t expected = 0;    // epochs that should have an answer, where there is a truth
  std::size_t epochs = 0;      // with a level and a true error
  std::size_t misleading = 0;  // with an error beyond the level
  // Errors of neighbouring epochs are alike. A block of `block_s` counts once, as misleading if any
  // of its epochs is.
  std::size_t blocks = 0, misleading_blocks = 0;
  double largest_ratio = 0.0;  // of an error to its level
  double observed_s = 0.0;     // the epochs' number times their spacing
  std::vector<AlertLimitCounts> limits;
  std::map<int, MultipleCounts> multiples;  // by tenths of sigma: how errors exceed other levels
  std::map<std::pair<int, int>, std::size_t> diagram;  // epochs by bins of error and level
};

// Where the counts of a run are cut.
struct IntegrityOptions {
  std::vector<double> alert_limits_m = {1.0, 3.0, 10.0};
  double block_s = 60.0;
};

// The counts of one run, or of several.
struct IntegrityEvaluation {
  std::string label;
  IntegrityCounts horizontal, vertical;
  IntegrityCounts heading;  // without alert limits
};

// Returns the bin of an error or a level in a Stanford diagram: 20 a decade, the first from 1 mm
// on.
int diagram_bin(double metres);

// These return the epochs with an error and a level. Headings count where the truth has a heading.
std::vector<LevelSample> horizontal_samples(const std::vector<ErrorSample>& errors);
std::vector<LevelSample> vertical_samples(const std::vector<ErrorSample>& errors);
std::vector<LevelSample> heading_samples(const std::vector<ErrorSample>& errors);

// Counts one quantity; `limits_m` may be empty, and then there is no diagram. Precondition: times
// increase.
IntegrityCounts count_integrity(const std::vector<LevelSample>& samples,
                                const std::vector<double>& limits_m, double block_s);

// Evaluates one run. Throws std::runtime_error if the solution states no level.
IntegrityEvaluation evaluate_integrity(const std::string& label, const Comparison& comparison,
                                       const IntegrityOptions& options);

// Adds counts with the same limits.
void add_counts(const IntegrityEvaluation& from, IntegrityEvaluation* to);

// These format evaluations as a table and as JSON, which holds all counts.
std::string to_table(const std::vector<IntegrityEvaluation>& evaluations,
                     const IntegrityOptions& options);
std::string to_json(const std::vector<IntegrityEvaluation>& evaluations,
                    const IntegrityOptions& options);

}  // namespace leonav
