// An hour of recorded HAS pages against the PyPI package cssrlib, and against the orbits
// themselves.
#include <map>

#include "drivers/has/has_decoder.h"
#include "drivers/page_lines/page_file_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/ssr/correction_store.h"
#include "support/catch.h"
#include "support/pages/page_oracle.h"
#include "support/pages/recorded_pages.h"
#include "support/recorded/shared_data.h"

namespace leonav {
namespace {

using test::kBroadcast;
using test::kHasPages;

// Decodes the hour; every message of clocks makes states at its own time.
struct Hour {
  Hour() {
    for (const Ephemeris& e : read_navigation(test::shared_data(kBroadcast)).ephemerides) {
      store.add(e);
    }
    PageFileReader reader(test::shared_data(kHasPages), PageService::kGalileoHas);
    for (CorrectionPage page; reader.next(&page);) {
      for (const SsrMessage& message : decoder.add(page)) {
        store.add(message);
        messages.push_back(message);
        test::add_values(message, &values);
        if (!has_clocks(message)) continue;
        for (const CorrectedState& state : store.states(message, message.time)) {
          test::add_value(state, &values);
          states.push_back(state);
        }
      }
    }
    bad_lines = reader.counters().bad_lines;
  }
  HasDecoder decoder;
  CorrectionStore store;
  std::vector<SsrMessage> messages;
  std::vector<CorrectedState> states;
  test::PageValues values;
  long bad_lines = 0;
};

}  // namespace

TEST_CASE("Every value of an hour of HAS is that of cssrlib, to the last bit") {
  if (!test::have_shared_data(kHasPages) || !test::have_shared_data(kBroadcast)) return;
  const Hour hour;
  const HasCounters c = hour.decoder.counters();
  CHECK(hour.bad_lines == 0);
  CHECK(c.messages == 432);
  CHECK(c.bad_checksums + c.bad_messages + c.bad_ids + c.bad_satellites == 0);
  CHECK(c.dummies == 3847);
  CHECK(c.pages + c.repeated + c.dummies == 17'145);
  if (!test::have_page_oracle()) return;
  const test::PageValues theirs =
      test::oracle_values("has", test::shared_data(kHasPages), test::shared_data(kBroadcast));
  for (const char kind : {'O', 'C', 'B', 'P', 'S'}) {
    const test::PageComparison found = test::compare(kind, hour.values, theirs);
    CHECK(found.different == 0);
    CHECK(found.theirs_alone == 0);
    CHECK(found.ours_alone == 0);
    if (kind == 'O') CHECK(found.same > 3500);
    if (kind == 'C') CHECK(found.same > 18'000);
    if (kind == 'B') CHECK(found.same > 11'000);
    if (kind != 'S') continue;
    CHECK(found.same > 5000);
    CHECK(found.position_m < 1e-4);
    CHECK(found.clock_m < 1e-4);
  }
}

}  // namespace leonav
