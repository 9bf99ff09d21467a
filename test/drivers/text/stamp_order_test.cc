#include "drivers/text/stamp_order.h"

#include <random>

#include "support/catch.h"

using namespace leonav;

namespace {

std::vector<GpsTime> stamps_of(const std::vector<double>& seconds) {
  std::vector<GpsTime> stamps;
  for (const double s : seconds) stamps.push_back(GpsTime::from_week_and_tow(2300, 1000.0 + s));
  return stamps;
}

std::vector<double> kept(const std::vector<double>& seconds) {
  const std::vector<bool> in_order = stamps_in_order(stamps_of(seconds));
  std::vector<double> result;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    if (in_order[i]) result.push_back(seconds[i]);
  }
  return result;
}

using Seconds = std::vector<double>;

}  // namespace

TEST_CASE("stamps in order stay, whatever their gaps", "[text]") {
  CHECK(kept({}).empty());
  CHECK(kept({5}) == Seconds{5});
  CHECK(kept({0, 1, 2, 100, 101, 90'000, 90'030}) == Seconds{0, 1, 2, 100, 101, 90'000, 90'030});
}

TEST_CASE("a stamp its successors contradict goes, not they", "[text]") {
  CHECK(kept({0, 1, 3600, 2, 3, 4}) == Seconds{0, 1, 2, 3, 4});
  CHECK(kept({3600, 1, 2, 3}) == Seconds{1, 2, 3});
  CHECK(kept({0, 1, -500, 2, 3}) == Seconds{0, 1, 2, 3});
  CHECK(kept({0, 1, 3600, 2}) == Seconds{0, 1, 2});
  CHECK(kept({0, 1, 1, 2, 2, 2, 3}) == Seconds{0, 1, 2, 3});
  CHECK(kept({0, 1, 3, 2, 4}) == Seconds{0, 1, 3, 4});  // either: the first stays
  CHECK(kept({0, 30, 3600, 60, 90}) == Seconds{0, 30, 60, 90});
}

TEST_CASE("up to fifteen wrong stamps in a row cost themselves", "[text]") {
  for (const int first : {0, 20, 50, 65}) {
    for (const double by : {3600.0, -3600.0}) {
      if (first == 0 && by < 0.0) continue;
      Seconds seconds, good;
      for (int i = 0; i < 100; ++i) {
        const bool wrong = i >= first && i < first + static_cast<int>(kStampsAhead / 2);
        seconds.push_back(wrong ? i + by : i);
        if (!wrong) good.push_back(i);
      }
      CAPTURE(first, by);
      CHECK(kept(seconds) == good);
    }
  }
}

TEST_CASE("whatever the stamps, what is kept increases", "[text]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> seconds(0.0, 50.0);
  for (int run = 0; run < 50; ++run) {
    Seconds input;
    for (int i = 0; i < 300; ++i) input.push_back(seconds(random) + 0.3 * i);
    const Seconds result = kept(input);
    CHECK(result.size() >= 10);
    for (std::size_t i = 1; i < result.size(); ++i) REQUIRE(result[i] > result[i - 1]);
  }
}
