// This unit tells in text what a filter has learned about the errors of its measurements.
#pragma once
#include <string>
#include <string_view>

#include "core/filter/error_model/learned_summary.h"

namespace leonav {

// Returns lines about one observable ("codes"): the factor on its configured sigma and how long
// its errors last, then the same by class.
std::string learned_errors_text(std::string_view observable, const ObservableErrors& errors);

}  // namespace leonav
