// An hour of recorded PPP-B2b pages against the PyPI package cssrlib.
#include "drivers/b2b/b2b_decoder.h"
#include "drivers/page_lines/page_file_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/ssr/correction_store.h"
#include "support/catch.h"
#include "support/page_oracle.h"
#include "support/shared_data.h"

namespace leonav {
namespace {

constexpr const char* kPages = "wire/b2b_189e.txt";
constexpr const char* kNavigation = "wire/broadcast_189.23P";

// Decodes the hour; every message of clocks makes states at its own time.
struct Hour {
  Hour() {
    for (const Ephemeris& e : read_navigation(test::shared_data(kNavigation)).ephemerides) {
      store.add(e);
    }
    PageFileReader reader(test::shared_data(kPages), PageService::kBeidouB2b);
    for (CorrectionPage page; reader.next(&page);) {
      for (const SsrMessage& message : decoder.add(page)) {
        store.add(message);
        test::add_values(message, &values);
        if (!has_clocks(message)) continue;
        for (const CorrectedState& state : store.states(message, message.time)) {
          test::add_value(state, &values);
        }
      }
    }
  }
  B2bDecoder decoder;
  CorrectionStore store;
  test::PageValues values;
};

}  // namespace

TEST_CASE("Every value of an hour of PPP-B2b is that of cssrlib, to the last bit") {
  if (!test::have_shared_data(kPages) || !test::have_shared_data(kNavigation)) return;
  const Hour hour;
  const B2bCounters& c = hour.decoder.counters();
  CHECK(c.empty == 6834);
  CHECK(c.bad_checksums + c.bad_satellites + c.bad_time + c.bad_length == 0);
  CHECK(c.other_types.empty());
  CHECK(hour.store.counters().of_unread_message > 0);
  if (!test::have_page_oracle()) return;
  const test::PageValues theirs =
      test::oracle_values("b2b", test::shared_data(kPages), test::shared_data(kNavigation));
  for (const char kind : {'O', 'C', 'B', 'S'}) {
    const test::PageComparison found = test::compare(kind, hour.values, theirs);
    CHECK(found.different == 0);
    CHECK(found.theirs_alone == 0);
    CHECK(found.ours_alone == 0);
    if (kind != 'S') continue;
    CHECK(found.same > 4000);
    CHECK(found.position_m < 1e-4);
    CHECK(found.clock_m < 1e-4);
  }
}

}  // namespace leonav
