// HeadingRecord collects the heading errors of one cold start at the instants of its evaluation. It
// also tests whether the errors agree with the stated sigmas.
#pragma once
#include <optional>
#include <vector>

namespace leonav {

// The heading at one epoch.
struct HeadingSample {
  double after_s = 0.0;          // since the start
  double since_aligned_s = 0.0;  // since the last alignment
  double error = 0.0;            // rad
  double sigma = 0.0;            // rad, as stated
};

// Returns whether the error exceeds both 5 degrees and five of its sigmas. A sigma excuses at most
// 15 degrees; that of a heading just aligned, 45.
bool is_off(const HeadingSample& sample);

// HeadingRecord is given a start's epochs in order.
class HeadingRecord {
 public:
  void add(double after_s, double error, double sigma);
  void add_without(double after_s);  // an epoch without heading

  const std::optional<HeadingSample>& first() const { return first_; }
  // nullopt: there was none at that time
  const std::optional<HeadingSample>& at_30_s() const { return at_30_s_; }
  const std::optional<HeadingSample>& last() const { return last_; }
  // Returns the samples at every alignment, 10 and 20 s after it, 30 s after the start and at the
  // last epoch, as far as there was a heading.
  std::vector<HeadingSample> judged() const;

 private:
  std::optional<double> aligned_after_s_;  // time of the alignment in force
  std::size_t next_ = 0;                   // index of the instants after it
  std::optional<HeadingSample> first_, at_30_s_, last_;
  std::vector<HeadingSample> after_alignment_;
};

// Returns whether an alignment was wrong when it was made or within 20 s.
bool has_false_alignment(const HeadingRecord& record);
// Returns whether a right alignment was off later.
bool has_diverged(const HeadingRecord& record);
// Returns the first evaluated instant at which the heading was off; nullopt: none.
std::optional<HeadingSample> first_off(const HeadingRecord& record);

}  // namespace leonav
