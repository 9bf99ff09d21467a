// How far apart a stream's epochs usually are.
#pragma once

namespace leonav {

// The epochs' usual interval: the shortest of late, so that a missing epoch does not count.
class UsualInterval {
 public:
  void add(double interval_s) {
    constexpr int kMissing = 5;  // so many longer intervals in a row are the usual one
    const bool longer = usual_s_ > 0.0 && interval_s > 1.1 * usual_s_;
    longer_ = longer ? longer_ + 1 : 0;
    if (longer && longer_ < kMissing) return;
    usual_s_ = interval_s;
  }
  double seconds() const { return usual_s_; }

 private:
  double usual_s_ = 0.0;
  int longer_ = 0;
};

}  // namespace leonav
