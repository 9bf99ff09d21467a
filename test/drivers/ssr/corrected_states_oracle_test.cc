// Corrected states of a recorded hour of SSR against the PyPI package cssrlib.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/base/calendar.h"
#include "core/gnss/signals/signal.h"
#include "drivers/rtcm3/rtcm3_decoder.h"
#include "drivers/ssr/correction_store.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

constexpr const char* kSsrHour = "wire/ssr_idd2023229c.rtc";

std::string oracle() {
  const char* python = std::getenv("LEONAV_PYTHON");
  return std::string("'") + (python != nullptr ? python : "python3") +
         "' '" LEONAV_SOURCE_DIR "/test/oracle/ssr_states.py' ";
}

bool have_cssrlib() {
  if (std::system((oracle() + "--have 2>/dev/null").c_str()) == 0) return true;
  std::cout << "SKIPPED (optional): no Python with cssrlib (LEONAV_PYTHON names another)\n";
  return false;
}

using Key = std::pair<long, SatelliteId>;  // second of the week

// Makes states of every message of orbits and clocks at its own time.
struct Maker : Rtcm3Handler {
  void on_epoch(const RawEpoch&) override {}
  void on_ephemeris(const Ephemeris& ephemeris) override { store.add(ephemeris); }
  void on_ssr(const SsrMessage& message) override {
    store.add(message);
    if (!has_clocks(message)) return;
    for (const CorrectedState& state : store.states(message, message.time)) {
      states[{std::lround(state.time.tow_s()), state.satellite}] = state;
    }
  }
  CorrectionStore store;
  std::map<Key, CorrectedState> states;
};

}  // namespace

TEST_CASE("States of a recorded hour agree with cssrlib to a tenth of a millimetre") {
  if (!test::have_shared_data(kSsrHour) || !have_cssrlib()) return;
  const std::string path = test::shared_data(kSsrHour);
  const test::TemporaryFile theirs("states.txt", "");
  REQUIRE(std::system((oracle() + "'" + path + "' 2275 >'" + theirs.path() + "'").c_str()) == 0);

  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  Maker maker;
  Rtcm3Decoder decoder({from_calendar({2023, 8, 17, 12, 0, 0.0})});
  decoder.feed({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, &maker);
  decoder.finish(&maker);

  std::size_t compared = 0, absent = 0;
  double position_m = 0.0, clock_m = 0.0;
  std::ifstream lines(theirs.path());
  long tow = 0;
  std::string name;
  Eigen::Vector3d p;
  for (double clock = 0.0; lines >> tow >> name >> p.x() >> p.y() >> p.z() >> clock;) {
    const auto ours = maker.states.find({tow, *satellite_from_string(name)});
    if (ours == maker.states.end()) {
      ++absent;
      continue;
    }
    ++compared;
    position_m = std::max(position_m, (ours->second.p_e - p).norm());
    clock_m = std::max(clock_m, std::abs(kSpeedOfLight * ours->second.clock_s - clock));
  }
  std::cout << "corrected states of cssrlib and ours: " << compared << " compared, " << absent
            << " theirs alone, " << maker.states.size() - compared
            << " ours alone; largest difference of position " << 1e3 * position_m
            << " mm, of clock " << 1e3 * clock_m << " mm\n";
  CHECK(compared > 15'000);
  CHECK(absent == 0);
  CHECK(position_m < 1e-4);
  CHECK(clock_m < 1e-4);
}

}  // namespace leonav
