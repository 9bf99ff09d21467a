// Medians of small tables.
#pragma once
#include <algorithm>
#include <cstddef>

namespace leonav {

// Median of a non-empty table of doubles (mean of the two middle ones); reorders its copy.
template <class Table>
double median(Table table) {
  const auto middle = table.begin() + static_cast<std::ptrdiff_t>(table.size() / 2);
  std::nth_element(table.begin(), middle, table.end());
  if (table.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(table.begin(), middle));
}

}  // namespace leonav
