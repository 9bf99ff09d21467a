// Which cold starts are called false, and which carried away.

#include "tools/starts/heading_record.h"
#include "core/base/angle.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

// Epochs at `from`, `from` + 1, ... before `to`, s, with one error and sigma, degrees.
void epochs(HeadingRecord* record, int from, int to, double error, double sigma) {
  for (int s = from; s < to; ++s) record->add(s, error * kDegree, sigma * kDegree);
}

HeadingRecord one(int aligned_s, double error, double sigma) {
  HeadingRecord record;
  for (int s = 0; s < aligned_s; ++s) record.add_without(s);
  epochs(&record, aligned_s, 60, error, sigma);
  return record;
}

bool is_right(const HeadingRecord& record) {
  return !has_false_alignment(record) && !has_diverged(record);
}

}  // namespace

TEST_CASE("a start is right within 5 degrees or five sigmas, and these excuse no more than 15") {
  CHECK(is_right(one(8, 4.9, 0.1)));
  CHECK(has_false_alignment(one(8, 5.1, 0.1)));
  CHECK(has_false_alignment(one(8, -5.1, 0.1)));
  CHECK(is_right(one(8, 9.9, 2.0)));
  CHECK(has_false_alignment(one(8, 10.1, 2.0)));
  CHECK(is_right(one(8, 14.9, 20.0)));
  CHECK(has_false_alignment(one(8, 15.1, 20.0)));
  CHECK(is_right(one(60, 0.0, 0.0)));  // not aligned at all
}

TEST_CASE("a heading that says how vague it is may be off by 45 degrees, for ten seconds") {
  HeadingRecord honest = one(8, 40.0, 10.0);
  CHECK(has_false_alignment(honest));  // it stays like that
  HeadingRecord settles;
  epochs(&settles, 8, 18, 40.0, 10.0);
  epochs(&settles, 18, 60, 1.0, 0.5);
  CHECK(is_right(settles));
  HeadingRecord far;
  epochs(&far, 8, 18, 46.0, 20.0);
  epochs(&far, 18, 60, 1.0, 0.5);
  CHECK(has_false_alignment(far));
}

TEST_CASE("a start that aligns late is judged after its first epoch too") {
  for (const int wrong_s : {50, 60}) {  // 10 and 20 s after it
    HeadingRecord late;
    epochs(&late, 40, wrong_s, 1.0, 0.5);
    epochs(&late, wrong_s, wrong_s + 2, 12.0, 0.5);
    epochs(&late, wrong_s + 2, 90, 1.0, 0.5);
    CHECK(has_false_alignment(late));
    CHECK_FALSE(late.at_30_s());
  }
}

TEST_CASE("right for twenty seconds and wrong later is carried away") {
  HeadingRecord at_end;
  epochs(&at_end, 5, 50, 0.5, 0.5);
  epochs(&at_end, 50, 60, 30.0, 0.5);
  CHECK_FALSE(has_false_alignment(at_end));
  CHECK(has_diverged(at_end));
  REQUIRE(first_off(at_end));
  CHECK(first_off(at_end)->after_s == 59.0);
  CHECK_FALSE(first_off(one(8, 1.0, 1.0)));
  HeadingRecord at_30_s;
  epochs(&at_30_s, 5, 28, 0.5, 0.5);
  epochs(&at_30_s, 28, 32, 30.0, 0.5);
  epochs(&at_30_s, 32, 60, 0.5, 0.5);
  CHECK(has_diverged(at_30_s));
  HeadingRecord soon;  // within twenty seconds: the alignment's own
  epochs(&soon, 20, 29, 0.5, 0.5);
  epochs(&soon, 29, 60, 30.0, 0.5);
  CHECK(has_false_alignment(soon));
  CHECK_FALSE(has_diverged(soon));
}

TEST_CASE("a heading found wrong and aligned anew is judged as any alignment, and was false") {
  HeadingRecord anew = one(5, 60.0, 2.0);
  for (int s = 60; s < 70; ++s) anew.add_without(s);
  CHECK_FALSE(anew.last());
  epochs(&anew, 70, 100, 1.0, 1.0);
  CHECK(has_false_alignment(anew));
  CHECK(anew.first()->after_s == 5.0);
  CHECK(anew.last()->since_aligned_s == 29.0);
  HeadingRecord second = one(5, 1.0, 1.0);
  second.add_without(60);
  epochs(&second, 61, 100, 60.0, 2.0);
  CHECK(has_false_alignment(second));
}

}  // namespace leonav::test
