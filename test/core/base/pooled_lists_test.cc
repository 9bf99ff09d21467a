#include "core/base/pooled_lists.h"

#include <utility>
#include <vector>

#include "support/catch.h"

using namespace leonav;

namespace {

struct Element {
  int value = 0;
  std::uint64_t arrival = 0;
  mutable GpsTime used;
};
template <std::size_t elements>
using Lists = PooledLists<Element, 3, 4, elements>;

template <typename Any>
void append(std::size_t list, int value, Any* lists) {
  lists->append(list) = {value, std::uint64_t(value), {}};
}

template <typename Any>
std::vector<int> values(const Any& lists, std::size_t list) {
  std::vector<int> values;
  for (const Element& element : lists[list]) values.push_back(element.value);
  return values;
}

}  // namespace

TEST_CASE("Lists in one pool keep their elements apart and in order", "[pooled_lists]") {
  Lists<6> lists;
  for (const int value : {1, 2, 3}) append(1, value, &lists);
  for (const int value : {4, 5}) append(2, value, &lists);
  CHECK(values(lists, 0).empty());
  CHECK(values(lists, 1) == std::vector{1, 2, 3});
  CHECK(values(lists, 2) == std::vector{4, 5});
  CHECK_FALSE(lists.is_full(1));
  append(1, 6, &lists);
  CHECK(lists.is_full(1));
  for (Element& element : lists[2]) ++element.value;
  CHECK(values(lists, 2) == std::vector{5, 6});
}

TEST_CASE("Where the pool is used up, the longest list loses what arrived first",
          "[pooled_lists]") {
  Lists<5> lists;
  for (const int value : {3, 2, 7, 4}) append(1, value, &lists);
  append(2, 5, &lists);
  append(0, 8, &lists);
  CHECK(values(lists, 0) == std::vector{8});
  CHECK(values(lists, 1) == std::vector{3, 7, 4});
  CHECK(values(lists, 2) == std::vector{5});
  // A list that is the longest itself makes its own room.
  append(1, 9, &lists);
  CHECK(values(lists, 1) == std::vector{7, 4, 9});
  // What was lost leaves nothing behind.
  CHECK(lists.append(0).value == 0);
}

TEST_CASE("Of lists that are as long, that with the oldest first element makes room",
          "[pooled_lists]") {
  Lists<6> lists;
  for (const int value : {3, 4}) append(0, value, &lists);
  for (const int value : {1, 2}) append(1, value, &lists);
  for (const int value : {5, 6}) append(2, value, &lists);
  append(2, 7, &lists);
  CHECK(values(lists, 0) == std::vector{3, 4});
  CHECK(values(lists, 1) == std::vector{2});
  CHECK(values(lists, 2) == std::vector{5, 6, 7});
}

TEST_CASE("What is in use makes room last, and longer ago it counts as the others",
          "[pooled_lists]") {
  const GpsTime begin = GpsTime::from_week_and_tow(2200, 0.0);
  Lists<5> lists;
  const auto use = [&](int value, double t_s) {
    for (const Element& element : std::as_const(lists)[1])
      if (element.value == value) lists.mark_used(element, begin.plus_seconds(t_s));
  };
  for (const int value : {1, 2, 3, 4}) append(1, value, &lists);
  append(2, 5, &lists);
  use(1, 0.0);
  use(2, 30.0);
  append(0, 6, &lists);
  CHECK(values(lists, 1) == std::vector{1, 2, 4});
  use(2, 70.0);  // the first one has served 70 s before
  append(0, 7, &lists);
  CHECK(values(lists, 1) == std::vector{2, 4});
  // Where all of a list is in use, what arrived first.
  use(4, 71.0);
  append(1, 8, &lists);
  CHECK(values(lists, 0) == std::vector{6, 7});
  CHECK(values(lists, 1) == std::vector{4, 8});
}
