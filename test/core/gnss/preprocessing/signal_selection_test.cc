#include "core/gnss/preprocessing/signal_selection.h"

#include <cmath>
#include <limits>
#include <vector>

#include "support/catch.h"

using namespace leonav;

namespace {

std::vector<SignalObservation> signals_of(System system, std::initializer_list<const char*> codes) {
  std::vector<SignalObservation> observations;
  for (const char* text : codes) {
    SignalObservation o;
    o.satellite = {system, 7};
    o.code = *signal_from_string(text);
    o.pseudorange_m = 2.2e7;
    o.cn0_dbhz = 40.0;
    observations.push_back(o);
  }
  return observations;
}

std::string name(const SignalObservation* o) { return o == nullptr ? "-" : to_string(o->code); }

std::string pair_of(System system, std::initializer_list<const char*> codes) {
  const GnssConfig config = default_gnss_config();
  const auto observations = signals_of(system, codes);
  const SelectedSignals s =
      select_signals(observations, config.systems[index_of(system)].signals, 0.0);
  return name(s.first) + " " + name(s.second);
}

}  // namespace

TEST_CASE("the pair is that of the preference, whatever the order of the signals") {
  CHECK(pair_of(System::kGps, {"1C", "2W", "5Q"}) == "1C 2W");
  CHECK(pair_of(System::kGps, {"5Q", "2W", "1C"}) == "1C 2W");
  CHECK(pair_of(System::kGps, {"1C", "2L", "2W"}) == "1C 2W");
  CHECK(pair_of(System::kGps, {"1C", "5X"}) == "1C 5X");
  CHECK(pair_of(System::kGps, {"1W", "1C"}) == "1C -");
  CHECK(pair_of(System::kGalileo, {"1X", "5X", "7X", "6X"}) == "1X 5X");
  CHECK(pair_of(System::kGalileo, {"1X", "7X"}) == "1X 7X");
  CHECK(pair_of(System::kBeidou, {"2I", "6I", "7I"}) == "2I 6I");
  CHECK(pair_of(System::kLeo, {"1C", "2W"}) == "1C 2W");
}

TEST_CASE("a pair that multiplies noise is not formed") {
  CHECK(pair_of(System::kGps, {"2W", "5Q"}) == "2W -");
  CHECK(pair_of(System::kBeidou, {"5X", "6I"}) == "6I -");
  CHECK(pair_of(System::kGalileo, {"5X", "6X"}) == "5X -");
}

TEST_CASE("no signal, or one out of range, weak or of no band, is not chosen") {
  const SignalPreference preference = default_gnss_config().systems[0].signals;
  CHECK(select_signals({}, preference, 0.0).first == nullptr);
  auto observations = signals_of(System::kGps, {"1C", "2W"});
  for (const double bad :
       {0.0, -2.2e7, 1.0e5, 1.0e8, std::nan(""), std::numeric_limits<double>::infinity()}) {
    observations[0].pseudorange_m = bad;
    const SelectedSignals s = select_signals(observations, preference, 0.0);
    CAPTURE(bad);
    CHECK(name(s.first) == "2W");
    CHECK(s.second == nullptr);
    CHECK(s.any_plausible);
  }
  observations[1].pseudorange_m = 1.0e5;
  const SelectedSignals implausible = select_signals(observations, preference, 0.0);
  CHECK(implausible.first == nullptr);
  CHECK(implausible.any_pseudorange);
  CHECK_FALSE(implausible.any_plausible);

  auto weak = signals_of(System::kGps, {"1C", "2W", "5Q"});
  weak[0].cn0_dbhz = 29.9;
  weak[1].cn0_dbhz = std::nan("");  // not told: stays
  weak[2].cn0_dbhz = 30.0;
  const SelectedSignals s = select_signals(weak, preference, 30.0);
  CHECK(s.bands.size() == 2);
  CHECK(name(s.first) == "2W");

  auto unknown = signals_of(System::kGps, {"1C"});
  unknown[0].code.band = '9';
  CHECK(select_signals(unknown, preference, 0.0).first == nullptr);
}
