// Configuration of a filter whose measurements have white errors of the configured size.
#pragma once
#include "core/filter/state/ekf_config.h"

namespace leonav {

// Synthetic measurements whose errors are drawn anew at each epoch agree with no other
// configuration: only with it is the filter's covariance the one of its errors.
inline EkfConfig white_error_config() {
  EkfConfig config;
  config.code_correlation_time_s = 0.0;
  config.doppler_correlation_time_s = 0.0;
  config.learn_errors = false;
  return config;
}

}  // namespace leonav
