// Street errors as random processes: their sizes, times and shares, and what the receiver makes of
// them.
#include "tools/sim/street/correlated_street.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/gnss/signals/signal.h"
#include "support/catch.h"
#include "support/sky/simulated_receiver.h"

using namespace leonav;
using namespace leonav::test;
using sim::CorrelatedStreet;
using sim::StreetEffect;

namespace {

constexpr double kLow = 0.4, kHigh = 1.2;  // rad

std::vector<StreetEffect> effects(const sim::StreetErrorsConfig& config, std::size_t satellite,
                                  double elevation, double turn, double step_s, int steps) {
  CorrelatedStreet street(config, 1, satellite);
  std::vector<StreetEffect> all;
  for (int i = 1; i <= steps; ++i) all.push_back(street.at({i * step_s, elevation, turn}));
  return all;
}

// Mean square of the codes of both signals, their product, and that with a lag.
struct Moments {
  double square = 0.0, between = 0.0, lagged = 0.0, carrier_square = 0.0;
};
Moments moments(const sim::StreetErrorsConfig& config, double elevation, double turn,
                std::size_t lag, double step_s = 1.0) {
  Moments sum;
  constexpr int kSatellites = 60, kSteps = 4000;
  for (std::size_t satellite = 0; satellite < kSatellites; ++satellite) {
    const auto all = effects(config, satellite, elevation, turn, step_s, kSteps);
    for (std::size_t i = 0; i + lag < all.size(); ++i) {
      const double a = all[i].signals[0].code_m, b = all[i].signals[1].code_m;
      sum.square += 0.5 * (a * a + b * b);
      sum.between += a * b;
      sum.lagged += a * all[i + lag].signals[0].code_m;
      sum.carrier_square += all[i].signals[0].carrier_m * all[i].signals[0].carrier_m;
    }
  }
  const double count = kSatellites * static_cast<double>(kSteps - static_cast<int>(lag));
  return {sum.square / count, sum.between / count, sum.lagged / count, sum.carrier_square / count};
}

// Mean square of a sigma that is drawn evenly.
double mean_square(const sim::Range& range) {
  return (range.least * range.least + range.least * range.most + range.most * range.most) / 3.0;
}

const std::string kStanding =
    "duration_s: 600\nroute: {standing_s: 600}\nideal: false\n"
    "receiver: {tracking: {half_cycle_share: 0}}\n";
const Keys kOff = {"street_errors.family=correlated",
                   "street_errors.reflected.share=0",
                   "street_errors.blocked.share=0",
                   "street_errors.slips.interval_s=1e9",
                   "street_errors.multipath.code_low_m=[0, 0]",
                   "street_errors.multipath.code_high_m=[0, 0]",
                   "street_errors.multipath.carrier_low_m=[0, 0]",
                   "street_errors.multipath.carrier_high_m=[0, 0]"};

Keys off_but(const Keys& keys) {
  Keys all = kOff;
  all.insert(all.end(), keys.begin(), keys.end());
  return all;
}

}  // namespace

TEST_CASE("Code and carrier errors have the sizes of their elevation", "[sim][street]") {
  const sim::StreetErrorsConfig config;
  const Moments low = moments(config, kLow, 1e-4, 1), high = moments(config, kHigh, 1e-4, 1);
  CHECK(low.square == Approx(mean_square(config.multipath.code_low_m)).epsilon(0.06));
  CHECK(high.square == Approx(mean_square(config.multipath.code_high_m)).epsilon(0.06));
  CHECK(low.carrier_square == Approx(mean_square(config.multipath.carrier_low_m)).epsilon(0.06));
  CHECK(high.carrier_square == Approx(mean_square(config.multipath.carrier_high_m)).epsilon(0.06));
  CHECK(low.between == Approx(0.5 * low.square).epsilon(0.1));
}

TEST_CASE("Errors are correlated over the time asked for, over a shorter one for fast satellites",
          "[sim][street]") {
  sim::StreetErrorsConfig config;
  config.multipath.time_s = {20.0, 20.0};
  for (const std::size_t lag : {10, 20, 40}) {
    const Moments m = moments(config, kLow, 1e-4, lag);
    INFO("lag " << lag);
    CHECK(m.lagged / m.square == Approx(std::exp(-static_cast<double>(lag) / 20.0)).margin(0.05));
  }
  // A low orbit turns twenty times as fast: 1 s instead of 20.
  const Moments low_orbit = moments(config, kLow, 24e-4, 10, 0.1);
  CHECK(low_orbit.lagged / low_orbit.square == Approx(std::exp(-1.0)).margin(0.05));
  // Geostationary satellites do not have longer ones.
  const Moments still = moments(config, kLow, 0.0, 20);
  CHECK(still.lagged / still.square == Approx(std::exp(-1.0)).margin(0.05));
}

TEST_CASE("The drawn correlation times lie where they are asked for", "[sim][street]") {
  // The mean of exp(-t/tau) over tau from 10 to 30 s, by Simpson's rule.
  const sim::StreetErrorsConfig config;
  for (const std::size_t lag : {10, 30}) {
    double mean = 0.0;
    constexpr int kParts = 100;
    for (int i = 0; i <= kParts; ++i) {
      const double weight = i == 0 || i == kParts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      mean += weight / (3.0 * kParts) *
              std::exp(-static_cast<double>(lag) / (10.0 + 20.0 * i / kParts));
    }
    // Sigmas that change with the episode, 120 s in the mean, lessen it a little.
    const Moments m = moments(config, kLow, 1e-4, lag);
    INFO("lag " << lag);
    CHECK(m.lagged / m.square == Approx(mean).margin(0.06));
  }
}

TEST_CASE("The Doppler's error is the rate of the carrier's, also where an episode begins",
          "[sim][street]") {
  sim::StreetErrorsConfig config;
  config.multipath.episode_s = 5.0;
  for (const auto& [turn, step_s] : {std::pair(1e-4, 0.01), std::pair(2e-3, 0.001)}) {
    double worst = 0.0, largest = 0.0;
    int rough = 0;
    const auto all = effects(config, 7, kLow, turn, step_s, 20'000);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      const sim::StreetSignalError &a = all[i].signals[1], &b = all[i + 1].signals[1];
      const double mean = 0.5 * (a.doppler_m_s + b.doppler_m_s);
      const double error = std::abs(b.carrier_m - a.carrier_m - step_s * mean);
      worst = std::max(worst, error);
      rough += error > 0.03 * 0.02 * step_s * (turn / 1e-4) ? 1 : 0;
      largest = std::max(largest, std::abs(a.doppler_m_s));
    }
    CHECK(largest > 1e-3);
    // Where an episode begins, every 5 s, the correlation time changes and the rate with it.
    CHECK(worst < largest * step_s);
    CHECK(rough < 80);
  }
}

TEST_CASE("Low satellites are reflected and blocked for their shares, high ones never",
          "[sim][street]") {
  const sim::StreetErrorsConfig config;
  std::vector<double> paths;
  int total = 0, reflected = 0, blocked = 0;
  for (std::size_t satellite = 0; satellite < 100; ++satellite) {
    std::set<unsigned> routes;
    for (const StreetEffect& now : effects(config, satellite, kLow, 1e-4, 1.0, 3000)) {
      ++total;
      blocked += now.possible ? 0 : 1;
      CHECK((now.extra_m > 0.0) == (now.route != 0));
      if (now.extra_m == 0.0) continue;
      ++reflected;
      CHECK(std::abs(now.extra_m_s) <= 0.3);
      CHECK((now.loss_db >= 3.0 && now.loss_db <= 10.0));
      if (routes.insert(now.route).second) paths.push_back(now.extra_m);
    }
    for (const StreetEffect& now : effects(config, satellite, kHigh, 1e-4, 1.0, 300)) {
      CHECK((now.possible && now.extra_m == 0.0 && now.loss_db == 0.0 && now.route == 0));
    }
  }
  CHECK(reflected == Approx(0.05 * total).epsilon(0.08));
  CHECK(blocked == Approx(0.15 * total).epsilon(0.05));
  // At their first epochs paths have drifted by 0.3 m at most: even in the logarithm from 5 to 50
  // m.
  std::sort(paths.begin(), paths.end());
  CHECK(paths.size() > 1000);
  CHECK((paths.front() > 4.5 && paths.back() < 50.5));
  CHECK(paths[paths.size() / 2] == Approx(std::sqrt(5.0 * 50.0)).epsilon(0.08));
  CHECK(paths[paths.size() / 4] == Approx(5.0 * std::pow(10.0, 0.25)).epsilon(0.08));
}

TEST_CASE("A reflection's way changes at its rate and never becomes shorter than the direct one",
          "[sim][street]") {
  sim::StreetErrorsConfig config;
  config.reflected = {0.5, 60.0, {5.0, 6.0}, 0.3, {3.0, 10.0}};
  int held = 0;
  for (std::size_t satellite = 0; satellite < 20; ++satellite) {
    const auto all = effects(config, satellite, kLow, 1e-4, 0.5, 4000);
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      if (all[i].route == 0 || all[i].route != all[i + 1].route) continue;
      CHECK(all[i + 1].extra_m >= 2.5);
      if (all[i].extra_m_s == 0.0 || all[i + 1].extra_m_s == 0.0) {
        ++held;
        continue;
      }
      CHECK(all[i + 1].extra_m - all[i].extra_m == Approx(0.5 * all[i].extra_m_s).margin(1e-9));
    }
  }
  CHECK(held > 0);
}

TEST_CASE("A reflection is in code, carrier and Doppler, and breaks the carrier at both ends",
          "[sim][street]") {
  const SimulatedEpochs plain = simulate_epochs(kStanding, kOff),
                        with = simulate_epochs(kStanding,
                                               off_but({"street_errors.reflected.share=0.2",
                                                        "street_errors.reflected.duration_s=30",
                                                        "receiver.noise.gps.code_m=0",
                                                        "receiver.noise.gps.doppler_m_s=0"}));
  const SimulatedEpochs quiet = simulate_epochs(
      kStanding, off_but({"receiver.noise.gps.code_m=0", "receiver.noise.gps.doppler_m_s=0"}));
  std::map<std::pair<SatelliteId, SignalCode>, double> last_late;
  int late = 0, breaks = 0;
  for (std::size_t k = 0; k < with.epochs.size(); ++k) {
    const BySignal base = by_signal(quiet.epochs[k]);
    for (const SignalObservation& o : with.epochs[k].observations) {
      const auto b = base.find({o.satellite, o.code});
      if (o.satellite.system != System::kGps || b == base.end()) continue;
      const double extra = o.pseudorange_m - b->second.pseudorange_m;
      const bool is_late = extra > 1.0;
      const auto before = last_late.find({o.satellite, o.code});
      if (is_late) {
        ++late;
        CHECK(extra < 50.0 + 0.3 * 300.0);
        const double rate =
            -(o.doppler_hz - b->second.doppler_hz) * wavelength_m(System::kGps, o.code.band);
        CHECK(std::abs(rate) <= 0.3001);
      } else {
        CHECK(std::abs(extra) < 1e-6);
      }
      if (before != last_late.end() && (before->second > 1.0) != is_late) {
        ++breaks;
        CHECK((std::isnan(o.carrier_cycles) || o.lock_time_s < 1.5));
      }
      last_late[{o.satellite, o.code}] = extra;
    }
  }
  CHECK(late > 300);
  CHECK(breaks > 20);
  CHECK(plain.epochs.size() == with.epochs.size());
}

TEST_CASE("What is blocked is not received, and its arc begins anew", "[sim][street]") {
  const SimulatedEpochs plain = simulate_epochs(kStanding, kOff),
                        with = simulate_epochs(kStanding,
                                               off_but({"street_errors.blocked.share=0.15"}));
  std::map<std::pair<SatelliteId, SignalCode>, std::size_t> last_seen;
  int missing = 0, all = 0, anew = 0;
  for (std::size_t k = 0; k < with.epochs.size(); ++k) {
    const BySignal there = by_signal(with.epochs[k]);
    all += static_cast<int>(plain.epochs[k].observations.size());
    missing += static_cast<int>(plain.epochs[k].observations.size() - there.size());
    for (const SignalObservation& o : with.epochs[k].observations) {
      const auto before = last_seen.find({o.satellite, o.code});
      if (before != last_seen.end() && before->second + 1 < k && !std::isnan(o.carrier_cycles)) {
        ++anew;
        CHECK(o.loss_of_lock);
      }
      if (!std::isnan(o.carrier_cycles)) last_seen[{o.satellite, o.code}] = k;
    }
  }
  CHECK(anew > 50);
  // Low satellites alone, of which 15 % of the time and a second of acquisition each time.
  CHECK(missing > 0.05 * all);
  CHECK(missing < 0.25 * all);
}

TEST_CASE("Slips of the street are in the carriers, as often and as they are drawn",
          "[sim][street]") {
  const SimulatedEpochs plain = simulate_epochs(kStanding, kOff),
                        with = simulate_epochs(kStanding,
                                               off_but({"street_errors.slips.interval_s=60"}));
  std::map<std::pair<SatelliteId, SignalCode>, double> offset;
  int events = 0, pairs = 0, told = 0;
  double satellite_s = 0.0;
  for (std::size_t k = 1; k < with.epochs.size(); ++k) {
    const BySignal base = by_signal(plain.epochs[k]);
    std::map<SatelliteId, std::vector<double>> hit;
    for (const SignalObservation& o : with.epochs[k].observations) {
      const SignalObservation& b = base.at({o.satellite, o.code});
      if (std::isnan(o.carrier_cycles)) continue;
      const double difference = std::round(o.carrier_cycles - b.carrier_cycles);
      double& before = offset[{o.satellite, o.code}];
      if (difference != before) hit[o.satellite].push_back(difference - before);
      if (difference != before && o.loss_of_lock) ++told;
      before = difference;
      satellite_s += 0.5;
    }
    for (const auto& [satellite, slips] : hit) {
      ++events;
      pairs += slips.size() == 2 && slips[0] == slips[1] && std::abs(slips[0]) == 1.0 ? 1 : 0;
    }
  }
  CHECK(events == Approx(satellite_s / 60.0).epsilon(0.15));
  CHECK(pairs == Approx(events / 3.0).epsilon(0.25));
  CHECK(told > 0.4 * events);
}

TEST_CASE("Without another family the streets' keys change nothing", "[sim][street]") {
  const std::string drive = "duration_s: 60\nroute: {standing_s: 10}\nplaces: city\n";
  const SimulatedEpochs plain = simulate_epochs(drive),
                        with = simulate_epochs(
                            drive, {"street_errors.family=rays", "street_errors.blocked.share=0.9",
                                    "street_errors.file=none.csv"});
  REQUIRE(plain.epochs.size() == with.epochs.size());
  for (std::size_t k = 0; k < plain.epochs.size(); ++k) {
    REQUIRE(same(plain.epochs[k], with.epochs[k]));
  }
}

TEST_CASE("Of an ideal run's street only the gaps are left", "[sim][street]") {
  const std::string yaml = "duration_s: 120\nroute: {standing_s: 120}\nideal: true\n";
  const SimulatedEpochs plain = simulate_epochs(yaml),
                        with = simulate_epochs(yaml, {"street_errors.family=correlated"});
  std::size_t fewer = 0;
  for (std::size_t k = 0; k < plain.epochs.size(); ++k) {
    const BySignal base = by_signal(plain.epochs[k]);
    fewer += base.size() - with.epochs[k].observations.size();
    for (const SignalObservation& o : with.epochs[k].observations) {
      CHECK(same(o.pseudorange_m, base.at({o.satellite, o.code}).pseudorange_m));
      CHECK(same(o.doppler_hz, base.at({o.satellite, o.code}).doppler_hz));
    }
  }
  CHECK(fewer > 0);
}

TEST_CASE("A satellite's street does not depend on which others exist", "[sim][street]") {
  const std::string drive = "duration_s: 120\nroute: {standing_s: 20}\n";
  const SimulatedEpochs all = simulate_epochs(drive, {"street_errors.family=correlated"}),
                        few = simulate_epochs(drive, {"street_errors.family=correlated",
                                                      "satellites.gps.enabled=false"});
  for (std::size_t k = 0; k < all.epochs.size(); ++k) {
    const BySignal whole = by_signal(all.epochs[k]);
    for (const SignalObservation& o : few.epochs[k].observations) {
      REQUIRE(same(o, whole.at({o.satellite, o.code})));
    }
  }
}
