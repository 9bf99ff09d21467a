// An hour of recorded PPP-B2b pages against the PyPI package cssrlib.
#include "drivers/b2b/b2b_decoder.h"
#include "drivers/page_lines/page_file_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/ssr/correction_store.h"
#include "support/catch.h"
#include "support/pages/page_oracle.h"
#include "support/pages/recorded_pages.h"
#include "support/recorded/shared_data.h"

namespace leonav {
namespace {

using test::kB2bPages;
using test::kBroadcast;

// Decodes the hour; every message of clocks makes states at its own time.
struct Hour {
  Hour() {
    for (const Ephemeris& e : read_navigation(test::shared_data(kBroadcast)).ephemerides) {
      store.add(e);
    }
    PageFileReader reader(test::shared_data(kB2bPages), PageService::kBeidouB2b);
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

// Whether the clock that goes with the orbit is older than it may be: that of the IOD Corr before,
// which ended 18 or 24 s ago. cssrlib uses a clock of any age.
bool is_of_old_clock(const test::PageValueKey& state, const test::PageValues& values) {
  const auto correction_issue = [&](long before_s) {
    const auto found =
        values.find({'C', std::get<1>(state) - before_s, std::get<2>(state), std::string()});
    return found == values.end() ? -1.0 : found->second[0];
  };
  const double now = correction_issue(0);
  return correction_issue(12) == now && correction_issue(24) != now;
}

}  // namespace

TEST_CASE("Every value of an hour of PPP-B2b is that of cssrlib, to the last bit") {
  if (!test::have_shared_data(kB2bPages) || !test::have_shared_data(kBroadcast)) return;
  const Hour hour;
  const B2bCounters& c = hour.decoder.counters();
  CHECK(c.empty == 6834);
  CHECK(c.bad_checksums + c.bad_satellites + c.bad_time + c.bad_length == 0);
  CHECK(c.other_types.empty());
  CHECK(hour.store.counters().without_bcnav1 > 0);
  if (!test::have_page_oracle()) return;
  const test::PageValues theirs =
      test::oracle_values("b2b", test::shared_data(kB2bPages), test::shared_data(kBroadcast));
  for (const char kind : {'O', 'C', 'B', 'S'}) {
    const test::PageComparison found = test::compare(kind, hour.values, theirs);
    CHECK(found.different == 0);
    CHECK(found.ours_alone == 0);
    if (kind != 'S') {
      CHECK(found.theirs_alone == 0);
      continue;
    }
    CHECK(found.same > 4600);
    CHECK(found.theirs_alone == 15);
    for (const test::PageValueKey& key : found.theirs) {
      INFO(std::get<1>(key) << " " << std::get<2>(key));
      CHECK(is_of_old_clock(key, theirs));
    }
    CHECK(found.position_m < 1e-4);
    CHECK(found.clock_m < 1e-4);
  }
}

}  // namespace leonav
