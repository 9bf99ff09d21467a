// This header computes the median of a small table.
#pragma once
#include <algorithm>
#include <cstddef>

namespace leonav {

// Returns the median of a non-empty table of doubles (mean of the two middle ones where their
// number is even). The table is passed by value and its copy is reordered.
template <class Table>
double median(Table table) {
  const auto middle = table.begin() + static_cast<std::ptrdiff_t>(table.size() / 2);
  std::nth_element(table.begin(), middle, table.end());
  if (table.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(table.begin(), middle));
}

}  // namespace leonav
