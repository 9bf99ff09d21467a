// The heading's errors of one cold start at the instants by which the start is judged, and whether
// they agree with what was told of them.
#pragma once
#include <optional>
#include <vector>

namespace leonav {

struct HeadingSample {
  double after_s = 0.0;          // since the start
  double since_aligned_s = 0.0;  // since its alignment, the last one where there were several
  double error = 0.0;            // rad
  double sigma = 0.0;            // rad, as it was told
};

// Further off than 5 degrees and five of its sigmas. A sigma excuses no more than 15 degrees; a
// heading that has just been aligned and says how vague it is, 45.
bool is_off(const HeadingSample& sample);

// Takes a start's epochs, one after the other.
class HeadingRecord {
 public:
  void add(double after_s, double error, double sigma);
  void add_without(double after_s);  // an epoch without heading

  const std::optional<HeadingSample>& first() const { return first_; }
  // Nullopt: there was none then.
  const std::optional<HeadingSample>& at_30_s() const { return at_30_s_; }
  const std::optional<HeadingSample>& last() const { return last_; }
  // Every alignment, 10 and 20 s after it, 30 s after the start, the last epoch; where there was a
  // heading.
  std::vector<HeadingSample> judged() const;

 private:
  std::optional<double> aligned_after_s_;  // of the alignment in force
  std::size_t next_ = 0;                   // of the instants after it
  std::optional<HeadingSample> first_, at_30_s_, last_;
  std::vector<HeadingSample> after_alignment_;
};

// An alignment was wrong: off when it was made or within 20 s.
bool is_false(const HeadingRecord& record);
// Aligned rightly, and off later.
bool is_carried_away(const HeadingRecord& record);
// The first of the judged instants at which it was off; nullopt: at none.
std::optional<HeadingSample> first_off(const HeadingRecord& record);

}  // namespace leonav
