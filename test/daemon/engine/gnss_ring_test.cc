// Work from `io` to `gnss`, in a queue where each list takes what it holds.
#include "daemon/engine/internal/gnss_ring.h"

#include <memory>
#include <thread>

#include "support/catch.h"
#include "support/wait_a_moment.h"

using namespace leonav;

namespace {

// An epoch whose lists have so many elements, each of which can be told from the others.
std::unique_ptr<GnssWork> epoch_of(std::uint64_t index, std::size_t observations,
                                   std::size_t samples, std::size_t increments) {
  auto work = std::make_unique<GnssWork>();
  auto& epoch = work->emplace<EpochWork>();
  epoch.index = index;
  epoch.time = GpsTime::from_week_and_tow(2400, static_cast<double>(index));
  epoch.raw.time = epoch.time.plus_seconds(0.001);
  epoch.smoother_decided = index % 2 == 0;
  epoch.raw.observations.resize(observations);
  epoch.block.resize(samples);
  epoch.odometer.resize(increments);
  const auto number = static_cast<double>(1000 * index);
  for (std::size_t i = 0; i < observations; ++i)
    epoch.raw.observations[i].pseudorange_m = number + static_cast<double>(i);
  for (std::size_t i = 0; i < samples; ++i)
    epoch.block[i].delta_theta_b.z() = number + static_cast<double>(i);
  for (std::size_t i = 0; i < increments; ++i)
    epoch.odometer[i].distance_m = number + static_cast<double>(i);
  return work;
}

void check_same(const EpochWork& a, const EpochWork& b) {
  // Does not compile with a field more, which must be compared too.
  const auto& [index, time, empty, raw, block, odometer, smoother_decided] = a;
  const auto& [raw_time, observations] = raw;
  CHECK(index == b.index);
  CHECK(time == b.time);
  CHECK(raw_time == b.raw.time);
  CHECK(empty == b.empty);
  CHECK(smoother_decided == b.smoother_decided);
  REQUIRE(observations.size() == b.raw.observations.size());
  REQUIRE(block.size() == b.block.size());
  REQUIRE(odometer.size() == b.odometer.size());
  bool same = true;
  for (std::size_t i = 0; i < observations.size(); ++i)
    same &= observations[i].pseudorange_m == b.raw.observations[i].pseudorange_m;
  for (std::size_t i = 0; i < block.size(); ++i)
    same &= block[i].delta_theta_b == b.block[i].delta_theta_b;
  for (std::size_t i = 0; i < odometer.size(); ++i)
    same &= odometer[i].distance_m == b.odometer[i].distance_m;
  CHECK(same);
}

template <typename List>
List list_of(std::size_t size, double List::value_type::*member) {
  List list;
  list.resize(size);
  for (std::size_t i = 0; i < size; ++i) list[i].*member = static_cast<double>(i);
  return list;
}

template <typename List>
void check_same(const GnssWork& work, const List& list, double List::value_type::*member) {
  const auto* got = std::get_if<List>(&work);
  REQUIRE(got != nullptr);
  REQUIRE(got->size() == list.size());
  bool same = true;
  for (std::size_t i = 0; i < list.size(); ++i) same &= (*got)[i].*member == list[i].*member;
  CHECK(same);
}

}  // namespace

TEST_CASE("work of every kind comes out of the ring to gnss as it went in") {
  Wakeup wakeup;
  GnssRing ring(&wakeup);
  const auto epoch = epoch_of(7, 100, 200, 30);
  const auto longest = epoch_of(8, kMaxObservations, kMaxImuBlock, kMaxOdometerBlock);
  const auto states = std::make_unique<PreciseStates>(
      list_of<PreciseStates>(kMaxEphemerisSatellites, &PreciseState::clock_s));
  const auto corrected = std::make_unique<CorrectedStates>(
      list_of<CorrectedStates>(kMaxCorrectedStates, &CorrectedState::clock_s));
  const auto biases =
      std::make_unique<SignalBiases>(list_of<SignalBiases>(kMaxBiases, &SignalBias::bias_m));
  Ephemeris ephemeris;
  ephemeris.af0 = 3.0;
  AntennaPattern pattern;
  pattern.variation.values = {1.0f, 2.0f};
  // Twice, so that the queues go round.
  for (int round = 0; round < 2; ++round) {
    ring.push(*epoch);
    ring.push(ephemeris);
    ring.push(*states);
    ring.push(*corrected);
    ring.push(*biases);
    ring.push(pattern);
    ring.push(Command{CommandKind::kSetHeading, 1.5, 0.1});
    ring.push(*longest);
    CHECK_FALSE(ring.idle());
    int count = 0;
    const auto check = [&](int place, const GnssWork& work) {
      if (place == 0) check_same(std::get<EpochWork>(work), std::get<EpochWork>(*epoch));
      if (place == 1) CHECK(std::get<Ephemeris>(work).af0 == 3.0);
      if (place == 2) check_same(work, *states, &PreciseState::clock_s);
      if (place == 3) check_same(work, *corrected, &CorrectedState::clock_s);
      if (place == 4) check_same(work, *biases, &SignalBias::bias_m);
      if (place == 5)
        CHECK(std::get<AntennaPattern>(work).variation.values == pattern.variation.values);
      if (place == 6) CHECK(std::get<Command>(work).value == 1.5);
      if (place == 7) check_same(std::get<EpochWork>(work), std::get<EpochWork>(*longest));
    };
    while (ring.consume_one([&](const GnssWork& work) { check(count++, work); })) {
    }
    CHECK(count == 8);
    CHECK(ring.idle());
  }
  CHECK(ring.statistics().waits == 0);
  CHECK(ring.statistics().high_water_percent > 20);
}

TEST_CASE("epochs that find no room in the ring to gnss wait, and none is lost") {
  Wakeup wakeup;
  GnssRing ring(&wakeup);
  constexpr std::uint64_t kEpochs = 50;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kEpochs; ++i) ring.push(*epoch_of(i, 10, kMaxImuBlock, 0));
  });
  while (ring.statistics().waits == 0) test::wait_a_moment();
  std::uint64_t next = 0;
  bool same = true;
  while (next < kEpochs)
    ring.consume_one([&](const GnssWork& work) {
      const auto& epoch = std::get<EpochWork>(work);
      same &= epoch.index == next && epoch.block.size() == kMaxImuBlock &&
              epoch.block[kMaxImuBlock - 1].delta_theta_b.z() ==
                  static_cast<double>(1000 * next + kMaxImuBlock - 1);
      ++next;
    });
  producer.join();
  CHECK(same);
  CHECK(ring.idle());
  CHECK(ring.statistics().high_water_percent == 100);
}
