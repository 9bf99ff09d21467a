// How far a long job is, for whoever watches.
#pragma once
#include <chrono>
#include <iosfwd>
#include <string>

namespace leonav {

// On a terminal one line that is drawn over itself, a few times a second, with the time that is
// left; anywhere else (a file, a pipe, nullptr) nothing at all.
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

// Whether standard error is a terminal.
bool is_stderr_terminal();

}  // namespace leonav
