#include "daemon/text/alignment_text.h"

#include "support/catch.h"

namespace leonav {
namespace {

TEST_CASE("what an alignment lacks, in words") {
  AlignmentConfig config;
  config.min_course_speed_m_s = 2.0;
  config.course_window_s = 6.0;
  config.max_reverse_speed_m_s = 5.0;
  CHECK(to_text({Lacking::kNothing}, config).empty());
  CHECK(to_text({Lacking::kPosition}, config) == "no position");
  CHECK(to_text({Lacking::kGravity}, config) ==
        "no level yet: the IMU is shaken, or its specific force is not of gravity's length");
  CHECK(to_text({Lacking::kNorth, 11.2}, config) ==
        "standing: the gyros need up to 20 s more to find north");
  CHECK(to_text({Lacking::kDriving}, config) ==
        "no heading: drive faster than 2 m/s for 6 s, or set_heading");
  config.confirming_s = 3.0;
  CHECK(to_text({Lacking::kDriving}, config) ==
        "no heading: drive faster than 2 m/s for 9 s, or set_heading");
  CHECK(to_text({Lacking::kCourse, 3.0}, config) == "no heading yet: drive on for up to 5 s more");
  CHECK(to_text({Lacking::kGear}, config) ==
        "no heading: forward or in reverse? speed up, turn, or drive faster than 5 m/s");
}

TEST_CASE("a need survives the gauge") {
  for (int kind = 0; kind <= static_cast<int>(Lacking::kAgreement); ++kind) {
    const AlignmentNeed need =
        unpack_alignment_need(pack_alignment_need({static_cast<Lacking>(kind), 17.3}));
    CHECK(static_cast<int>(need.lacking) == kind);
    CHECK(need.seconds == 18.0);
  }
}

}  // namespace
}  // namespace leonav
