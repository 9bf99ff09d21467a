// RAWX against RTKLIB's convbin, every number of walk/gnss.obs, and against pyubx2.
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "drivers/rinex/observation_reader.h"
#include "drivers/ubx/oracle_program.h"
#include "drivers/ubx/walk_recording.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

// Convbin names components differently: match by band.
using BandKey = std::pair<SatelliteId, char>;

// RINEX holds three decimals; half of the last one, and the rounding of the sum itself.
constexpr double kHalfDigit = 0.0005 + 1e-6;

struct Comparison {
  long values = 0;
  long different = 0;
  long only_ours = 0;
  long only_theirs = 0;

  void add(double ours, double theirs, double tolerance) {
    if (std::isnan(ours) && std::isnan(theirs)) return;
    if (std::isnan(theirs)) {
      ++only_ours;
    } else if (std::isnan(ours)) {
      ++only_theirs;
    } else {
      ++values;
      if (std::abs(ours - theirs) > tolerance) ++different;
    }
  }
};

std::vector<RawEpoch> read_rinex(const std::string& path) {
  std::vector<RawEpoch> epochs;
  ObservationReader reader(path);
  RawEpoch epoch;
  while (reader.next(&epoch)) epochs.push_back(epoch);
  return epochs;
}

// B1C came with RTKLIB versions after the one that wrote the file.
bool convbin_knows(const SignalObservation& o) {
  return !(o.satellite.system == System::kBeidou && o.code.band == '1');
}

}  // namespace

TEST_CASE("RAWX agrees with RTKLIB's RINEX in every value") {
  if (!test::have_shared_data(test::kWalkUbx) || !test::have_shared_data("walk/gnss.obs")) return;
  const auto ours = test::decode_walk();
  const auto theirs = read_rinex(test::shared_data("walk/gnss.obs"));
  REQUIRE(ours.epochs.size() == 536);
  REQUIRE(theirs.size() == ours.epochs.size());

  Comparison code, carrier, doppler, cn0;
  long unmatched_ours = 0, unmatched_theirs = 0, b1c = 0, half_cycles_differ = 0, half_cycles = 0;
  long carriers_only_ours_after_first_epoch = 0;
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    REQUIRE(ours.epochs[k].time == theirs[k].time);
    std::map<BandKey, SignalObservation> rinex;
    for (const auto& o : theirs[k].observations) rinex[{o.satellite, o.code.band}] = o;
    REQUIRE(rinex.size() == theirs[k].observations.size());
    for (const auto& o : ours.epochs[k].observations) {
      if (!convbin_knows(o)) {
        ++b1c;
        continue;
      }
      const auto found = rinex.find({o.satellite, o.code.band});
      if (found == rinex.end()) {
        ++unmatched_ours;
        continue;
      }
      const SignalObservation& r = found->second;
      const long before = carrier.only_ours;
      code.add(o.pseudorange_m, r.pseudorange_m, kHalfDigit);
      carrier.add(o.carrier_cycles, r.carrier_cycles, kHalfDigit);
      doppler.add(o.doppler_hz, r.doppler_hz, kHalfDigit);
      cn0.add(o.cn0_dbhz, r.cn0_dbhz, 1e-9);
      if (k > 0) carriers_only_ours_after_first_epoch += carrier.only_ours - before;
      if (std::isfinite(o.carrier_cycles) && std::isfinite(r.carrier_cycles)) {
        ++half_cycles;
        if (o.half_cycle_ambiguous != r.half_cycle_ambiguous) ++half_cycles_differ;
      }
      rinex.erase(found);
    }
    unmatched_theirs += static_cast<long>(rinex.size());
  }

  // 36,271 measurements of our systems, of which 4,174 are B1C.
  CHECK(b1c == 4174);
  CHECK(unmatched_ours == 0);
  CHECK(unmatched_theirs == 0);
  CHECK(code.values == 32097);
  CHECK(doppler.values == 32097);
  CHECK(cn0.values == 32097);
  CHECK(carrier.values == 28220);
  CHECK(half_cycles == carrier.values);
  CHECK(half_cycles_differ == 0);
  for (const Comparison* c : {&code, &carrier, &doppler, &cn0}) {
    CHECK(c->different == 0);
    CHECK(c->only_theirs == 0);
  }
  CHECK(code.only_ours == 0);
  CHECK(doppler.only_ours == 0);
  CHECK(cn0.only_ours == 0);
  // Until it meets the first modern signal, convbin takes the receiver for an older model, from
  // which it accepts only the best carriers: it misses three in the first epoch.
  CHECK(carrier.only_ours == 3);
  CHECK(carriers_only_ours_after_first_epoch == 0);
}

TEST_CASE("Loss of lock agrees with RTKLIB but where it is blind or early") {
  if (!test::have_shared_data(test::kWalkUbx) || !test::have_shared_data("walk/gnss.obs")) return;
  const auto ours = test::decode_walk();
  const auto theirs = read_rinex(test::shared_data("walk/gnss.obs"));
  REQUIRE(theirs.size() == ours.epochs.size());

  std::map<BandKey, GpsTime> last_carrier;
  std::set<BandKey> seen_by_rtklib;
  long both = 0, neither = 0, unexplained = 0, theirs_at_first = 0, ours_after_gap = 0;
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    std::map<BandKey, SignalObservation> rinex;
    for (const auto& o : theirs[k].observations) rinex[{o.satellite, o.code.band}] = o;
    for (const auto& o : ours.epochs[k].observations) {
      if (!convbin_knows(o) || std::isnan(o.carrier_cycles)) continue;
      const BandKey key{o.satellite, o.code.band};
      const bool is_first = !last_carrier.contains(key);
      const double gap_s = is_first ? 0.0 : seconds_between(ours.epochs[k].time, last_carrier[key]);
      last_carrier[key] = ours.epochs[k].time;
      const SignalObservation& r = rinex.at(key);
      if (std::isnan(r.carrier_cycles)) continue;
      const bool is_their_first = seen_by_rtklib.insert(key).second;
      if (o.loss_of_lock && r.loss_of_lock) {
        ++both;
      } else if (!o.loss_of_lock && !r.loss_of_lock) {
        ++neither;
      } else if (r.loss_of_lock && is_their_first) {
        ++theirs_at_first;  // a signal's first carrier interrupts nothing
      } else if (o.loss_of_lock && o.lock_time_s < gap_s) {
        ++ours_after_gap;  // lock younger than the last carrier; RTKLIB compares counters only
      } else {
        ++unexplained;
      }
    }
  }
  CHECK(unexplained == 0);
  CHECK(both == 1209);
  CHECK(neither == 26971);
  CHECK(theirs_at_first == 21);
  CHECK(ours_after_gap == 19);
}

TEST_CASE("RAWX agrees with pyubx2 in every value, to the last bit") {
  if (!test::have_shared_data(test::kWalkUbx) || !test::have_pyubx2()) return;
  using Key = std::tuple<GpsTime, SatelliteId, SignalCode>;
  std::map<Key, SignalObservation> left;
  for (const RawEpoch& epoch : test::decode_walk().epochs) {
    for (const auto& o : epoch.observations) left[{epoch.time, o.satellite, o.code}] = o;
  }
  const test::TemporaryFile place("rawx.txt", "");
  const std::string command = test::ubx_oracle() + "rawx '" + test::shared_data(test::kWalkUbx) +
                              "' >'" + place.path() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  std::ifstream lines(place.path());
  long signals = 0, carriers = 0, missing = 0, different = 0;
  const auto differ = [](double ours, double theirs) {
    return ours != theirs && !(std::isnan(ours) && std::isnan(theirs));
  };
  std::int64_t time_ns = 0, lock_ms = 0;
  std::string satellite, code, range_m, carrier_cycles, doppler_hz, cn0_dbhz;
  bool is_half_cycle_known = false;
  while (lines >> time_ns >> satellite >> code >> range_m >> carrier_cycles >> doppler_hz >>
         cn0_dbhz >> lock_ms >> is_half_cycle_known) {
    ++signals;
    const auto found = left.find({GpsTime::from_nanoseconds(time_ns),
                                  *satellite_from_string(satellite), *signal_from_string(code)});
    if (found == left.end()) {
      ++missing;
      continue;
    }
    const SignalObservation& o = found->second;
    const bool has_carrier = !std::isnan(std::stod(carrier_cycles));
    carriers += has_carrier;
    different += differ(o.pseudorange_m, std::stod(range_m)) ||
                 differ(o.carrier_cycles, std::stod(carrier_cycles)) ||
                 differ(o.doppler_hz, std::stod(doppler_hz)) ||
                 differ(o.cn0_dbhz, std::stod(cn0_dbhz)) ||
                 differ(o.lock_time_s, static_cast<double>(lock_ms) * 1e-3) ||
                 (has_carrier && o.half_cycle_ambiguous == is_half_cycle_known);
    left.erase(found);
  }
  CHECK(signals == 36'271);
  CHECK(carriers == 32'070);
  CHECK(missing == 0);
  CHECK(left.empty());
  CHECK(different == 0);
}

// An oracle of its own for the one signal that convbin leaves out: the Doppler of one satellite on
// two signals goes as their frequencies.
TEST_CASE("The signal taken for B1C moves like 1575.42 MHz") {
  if (!test::have_shared_data(test::kWalkUbx)) return;
  const auto ours = test::decode_walk();
  long pairs = 0, outside = 0;
  for (const RawEpoch& epoch : ours.epochs) {
    std::map<SatelliteId, double> b2a;
    for (const auto& o : epoch.observations) {
      if (o.satellite.system == System::kBeidou && o.code.band == '5' && o.cn0_dbhz > 40) {
        b2a[o.satellite] = o.doppler_hz;
      }
    }
    for (const auto& o : epoch.observations) {
      if (o.satellite.system != System::kBeidou || o.code != SignalCode{'1', 'P'}) continue;
      if (o.cn0_dbhz < 40 || !b2a.contains(o.satellite)) continue;
      ++pairs;
      // B1I (1561.098 MHz) would be off by 1 % of up to 3000 Hz.
      if (std::abs(o.doppler_hz - b2a[o.satellite] * 1575.42 / 1176.45) > 3.0) ++outside;
    }
  }
  CHECK(pairs > 1000);
  CHECK(outside < pairs / 100);
}

}  // namespace leonav
