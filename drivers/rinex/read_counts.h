// This unit counts what a reader used and what it skipped, by reason.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// Counts of the epochs or records of a file.
struct ReadCounts {
  struct Skip {
    std::string reason;
    long count = 0;
    long first_line = 0;  // 1 is the first line of the file
  };

  long used = 0;              // epochs or records returned
  std::vector<Skip> skipped;  // in order of first occurrence

  void skip(std::string_view reason, long line, long count = 1);
  long skipped_total() const;
  long count_of(std::string_view reason) const;  // 0 if it did not occur
  // Whether something was skipped, and each time for what it is: such reasons end in "not used)".
  bool all_skipped_by_design() const;
};

}  // namespace leonav
