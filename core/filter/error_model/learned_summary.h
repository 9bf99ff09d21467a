// LearnedSummary says in a few numbers what a filter has learned about errors.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "core/gnss/signals/satellite.h"

namespace leonav {

// The classes of ErrorClass one property at a time: system, elevation, signal, lost strength.
inline constexpr std::array<std::string_view, 14> kLearnedClassNames = {"GPS",
                                                                        "Galileo",
                                                                        "BeiDou",
                                                                        "LEO",
                                                                        "below 20 deg",
                                                                        "20 to 35 deg",
                                                                        "35 to 50 deg",
                                                                        "above 50 deg",
                                                                        "one frequency",
                                                                        "pair",
                                                                        "up to 3 dB weaker",
                                                                        "3 to 6 dB weaker",
                                                                        "6 to 10 dB weaker",
                                                                        "over 10 dB weaker"};

// The errors of a class, or of an observable.
struct LearnedError {
  double sigma_factor = 1.0;        // of the configured sigma
  double correlated_share = 0.0;    // of the variance
  double correlation_time_s = 0.0;  // 0: not learned by this property
};

// The learned errors of one observable, of the vehicle as it moves or stands.
struct ObservableErrors {
  LearnedError all;  // over the classes; share and time are means over elevations
  // By kLearnedClassNames: what the property alone makes of `all`. Correlation is learned by
  // elevation.
  std::array<LearnedError, kLearnedClassNames.size()> classes;
};

struct LearnedSummary {
  bool learned = false;  // false: errors are as configured, and the rest says nothing
  ObservableErrors code, doppler;
  // LastingErrors::own_sigma_m() per System, m.
  std::array<double, kSystemCount> lasting_m{};
};

}  // namespace leonav
