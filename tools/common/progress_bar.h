// ProgressBar shows the progress of a long job on a terminal.
#pragma once
#include <chrono>
#include <iosfwd>
#include <string>

namespace leonav {

// The bar is one line that is redrawn a few times a second, with the remaining time. Where `out` is
// not a terminal (a file, a pipe, nullptr) it prints nothing.
class ProgressBar {
 public:
  ProgressBar(std::ostream* out, std::string label, bool is_terminal);
  ~ProgressBar();  // clears the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double share);  // of the job, in [0, 1]

 private:
  std::ostream* out_;  // nullptr: quiet
  std::string label_;
  std::chrono::steady_clock::time_point started_, drawn_;
  bool is_drawn_ = false;
};

// Returns whether standard error is a terminal.
bool is_stderr_terminal();

}  // namespace leonav
