// What a reader used of a file and what it left out, by reason.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

struct ReadCounts {
  struct Skip {
    std::string reason;
    long count = 0;
    long first_line = 0;  // 1 is the first line of the file
  };

  long used = 0;              // epochs or records handed on
  std::vector<Skip> skipped;  // in order of first occurrence

  void skip(std::string_view reason, long line, long count = 1);
  long skipped_total() const;
  long count_of(std::string_view reason) const;  // 0 if it did not occur
};

}  // namespace leonav
