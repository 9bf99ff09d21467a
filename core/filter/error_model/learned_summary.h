// LearnedSummary says in a few numbers what a filter has learned about errors.
#pragma once

namespace leonav {

// The errors of one observable, over its classes.
struct LearnedError {
  double sigma_factor = 1.0;        // of the configured sigma
  double correlation_time_s = 0.0;  // mean over elevations, of the vehicle as it moves or stands
};

struct LearnedSummary {
  bool learned = false;  // false: errors are as configured, and the rest says nothing
  LearnedError code, doppler;
};

}  // namespace leonav
