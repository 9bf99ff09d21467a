#include "tools/common/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <ostream>
#include <utility>

#include "tools/common/format.h"

namespace leonav {
namespace {

constexpr int kWidth = 30;
constexpr std::chrono::milliseconds kRedraw{200};

}  // namespace

ProgressBar::ProgressBar(std::ostream* out, std::string label, bool is_terminal)
    : out_(is_terminal ? out : nullptr),
      label_(std::move(label)),
      started_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  if (is_drawn_) *out_ << "\r\033[K" << std::flush;
}

void ProgressBar::show(double share) {
  if (out_ == nullptr) return;
  const auto now = std::chrono::steady_clock::now();
  if (is_drawn_ && now - drawn_ < kRedraw) return;
  is_drawn_ = true;
  drawn_ = now;
  const double done = std::clamp(share, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(done * kWidth);
  const double spent_s = std::chrono::duration<double>(now - started_).count();
  std::string line = "\r" + label_ + " [" + std::string(filled, '#') +
                     std::string(kWidth - filled, ' ') + format("] %3.0f %%", 100.0 * done);
  if (done > 0.02) line += format(", %.0f s left", spent_s * (1.0 - done) / done);
  *out_ << line << "\033[K" << std::flush;
}

bool is_stderr_terminal() { return isatty(STDERR_FILENO) != 0; }

}  // namespace leonav
