// Cn0Distribution computes mean and percentiles of C/N0 values without storing them.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace leonav {

// The values, in dB-Hz, are counted in cells of 0.1 from 0 to 100; values beyond count in the
// outermost cells.
class Cn0Distribution {
 public:
  void add(double cn0_dbhz) {
    if (!std::isfinite(cn0_dbhz)) return;
    if (cells_.empty()) cells_.resize(kCells);
    const double cell = std::round(cn0_dbhz / kWidth);
    ++cells_[cell <= 0.0 ? 0 : cell >= kCells - 1 ? kCells - 1 : static_cast<std::size_t>(cell)];
    sum_ += cn0_dbhz;
    ++count_;
  }
  void add(const Cn0Distribution& other) {
    if (other.cells_.empty()) return;
    if (cells_.empty()) cells_.resize(kCells);
    for (std::size_t i = 0; i < kCells; ++i) cells_[i] += other.cells_[i];
    sum_ += other.sum_;
    count_ += other.count_;
  }

  std::uint64_t count() const { return count_; }
  double mean() const { return count_ == 0 ? kNone : sum_ / static_cast<double>(count_); }
  // Returns the smallest value that at least `share` (0 to 1) of the values do not exceed; NaN
  // without values.
  double percentile(double share) const {
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      seen += cells_[i];
      if (seen > 0 && static_cast<double>(seen) >= share * static_cast<double>(count_))
        return static_cast<double>(i) * kWidth;
    }
    return kNone;
  }

 private:
  static constexpr std::size_t kCells = 1001;
  static constexpr double kWidth = 0.1;
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::vector<std::uint64_t> cells_;
  double sum_ = 0.0;
  std::uint64_t count_ = 0;
};

}  // namespace leonav
