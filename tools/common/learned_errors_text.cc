#include "tools/common/learned_errors_text.h"

#include <array>

#include "tools/common/format.h"

namespace leonav {
namespace {

// Classes of one property stand on one line.
constexpr std::array<std::size_t, 4> kLineEnds = {4, 8, 10, 14};
static_assert(kLineEnds.back() == kLearnedClassNames.size());

}  // namespace

std::string learned_errors_text(std::string_view observable, const LearnedErrorsOf& errors) {
  std::string text(observable);
  text += format(
      ": %.2f times the configured sigma, %.0f %% of the variance correlated over %.1f s\n",
      errors.all.sigma_factor, 100.0 * errors.all.correlated_share, errors.all.correlation_time_s);
  std::size_t i = 0;
  for (const std::size_t end : kLineEnds) {
    for (const char* before = "  "; i < end; ++i, before = ", ") {
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
