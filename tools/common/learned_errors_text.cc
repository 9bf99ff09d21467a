#include "tools/common/learned_errors_text.h"

#include <array>

#include "core/filter/error_model/error_class.h"
#include "tools/common/format.h"

namespace leonav {
namespace {

// Classes of one property stand on one line.
constexpr std::array kClassesOfALine = {kSystemCount, kElevationClasses, kSignalClasses,
                                        kLossClasses};

}  // namespace

std::string learned_errors_text(std::string_view observable, const ObservableErrors& errors) {
  std::string text(observable);
  text += format(
      ": %.2f times the configured sigma, %.0f %% of the variance correlated over %.1f s\n",
      errors.all.sigma_factor, 100.0 * errors.all.correlated_share, errors.all.correlation_time_s);
  std::size_t i = 0;
  for (const std::size_t classes : kClassesOfALine) {
    const char* before = "  ";
    for (const std::size_t end = i + classes; i < end; ++i, before = ", ") {
      const LearnedError& of = errors.classes[i];
      text += before;
      text += std::string(kLearnedClassNames[i]) + format(" %.2f", of.sigma_factor);
      if (of.correlation_time_s > 0.0)
        text +=
            format(" (%.0f %% over %.1f s)", 100.0 * of.correlated_share, of.correlation_time_s);
    }
    text += "\n";
  }
  return text;
}

}  // namespace leonav
