#include "daemon/text/reset_text.h"

#include <set>

#include "support/catch.h"

namespace leonav {
namespace {

TEST_CASE("each cause of a reset has words of its own") {
  std::set<std::string_view> texts;
  const int causes = static_cast<int>(ResetCause::kImuGap) + 1;
  for (int cause = 0; cause < causes; ++cause)
    texts.insert(reset_text(static_cast<ResetCause>(cause)));
  CHECK(texts.size() == static_cast<std::size_t>(causes));
  CHECK_FALSE(texts.contains("unknown"));
  CHECK(reset_text(ResetCause::kHeading) == "the heading contradicts the motion");
}

}  // namespace
}  // namespace leonav
