#include "core/gnss/preprocessing/receiver_code_bias.h"

#include <cmath>
#include <random>

#include "support/catch.h"

using namespace leonav;

namespace {

const GpsTime kBeginOfWeek = GpsTime::from_week_and_tow(2200, 0.0);

InterBandDifferences around(double value, double sigma, std::mt19937* generator) {
  std::normal_distribution<double> normal;
  InterBandDifferences differences;
  differences.sigma_m = sigma;
  for (int i = 0; i < 9; ++i) differences.values_m.push_back(value + sigma * normal(*generator));
  return differences;
}

void feed(ReceiverCodeBiases* biases, int epoch, const InterBandDifferences& differences) {
  biases->open(kBeginOfWeek.plus_seconds(epoch));
  biases->set_reference(System::kGps, '1');
  biases->update(System::kGps, '5', differences);
}

}  // namespace

TEST_CASE("a band's delay is averaged over epochs and its variance is honest") {
  double squares = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937 generator(static_cast<unsigned>(run));
    ReceiverCodeBiases biases;
    for (int epoch = 0; epoch < 30; ++epoch) feed(&biases, epoch, around(2357.0, 3.0, &generator));
    const double error = biases.offset_m(System::kGps, '5') - 2357.0;
    squares += error * error / biases.variance_m2(System::kGps, '5') / kRuns;
  }
  // The spread is never taken below the claimed sigma, so the variance errs on the large side.
  CHECK(squares > 0.4);
  CHECK(squares < 1.2);
}

TEST_CASE("an unknown band, and the reference itself, have no delay") {
  ReceiverCodeBiases biases;
  CHECK(biases.offset_m(System::kGps, '5') == 0.0);
  std::mt19937 generator(1);
  feed(&biases, 0, around(10.0, 1.0, &generator));
  CHECK(biases.offset_m(System::kGps, '1') == 0.0);
  CHECK(biases.offset_m(System::kGalileo, '5') == 0.0);
  CHECK(biases.offset_m(System::kGps, 0) == 0.0);
  CHECK(biases.offset_m(System::kGps, '\xff') == 0.0);
  biases.set_reference(System::kGps, '2');
  CHECK(biases.offset_m(System::kGps, '5') == 0.0);
  biases.update(System::kGps, '5', {});
  CHECK(biases.variance_m2(System::kGps, '5') == 0.0);
}

TEST_CASE("the same epoch twice counts once") {
  std::mt19937 generator(2);
  ReceiverCodeBiases once, twice;
  for (int epoch = 0; epoch < 5; ++epoch) {
    const InterBandDifferences differences = around(-4.0, 1.0, &generator);
    feed(&once, epoch, differences);
    feed(&twice, epoch, around(0.0, 1.0, &generator));
    feed(&twice, epoch, differences);
  }
  CHECK(twice.offset_m(System::kGps, '5') == once.offset_m(System::kGps, '5'));
  CHECK(twice.variance_m2(System::kGps, '5') == once.variance_m2(System::kGps, '5'));
}

TEST_CASE("a step that is allowed for is followed at once, of its own system alone") {
  for (const System widened : {System::kGps, System::kGalileo}) {
    std::mt19937 generator(4);
    ReceiverCodeBiases biases;
    for (int epoch = 0; epoch < 60; ++epoch) feed(&biases, epoch, around(5.0, 1.0, &generator));
    const double before_m2 = biases.variance_m2(System::kGps, '5');
    biases.widen(widened, 25.0);
    feed(&biases, 60, around(8.0, 1.0, &generator));
    const double offset_m = biases.offset_m(System::kGps, '5');
    if (widened == System::kGps) {
      CHECK(std::abs(offset_m - 8.0) < 1.0);
      CHECK(biases.variance_m2(System::kGps, '5') > before_m2);
    } else {
      CHECK(std::abs(offset_m - 5.0) < 1.0);
    }
  }
}

TEST_CASE("a strange epoch is passed over, a new delay is taken after five") {
  std::mt19937 generator(3);
  ReceiverCodeBiases biases;
  for (int epoch = 0; epoch < 20; ++epoch) feed(&biases, epoch, around(5.0, 1.0, &generator));
  feed(&biases, 20, around(300.0, 1.0, &generator));
  CHECK(std::abs(biases.offset_m(System::kGps, '5') - 5.0) < 1.0);
  for (int epoch = 21; epoch < 26; ++epoch) feed(&biases, epoch, around(300.0, 1.0, &generator));
  CHECK(std::abs(biases.offset_m(System::kGps, '5') - 300.0) < 2.0);
  // Two satellites of nine far off do not move the median.
  InterBandDifferences spoiled = around(300.0, 1.0, &generator);
  spoiled.values_m[0] += 1.0e6;
  spoiled.values_m[1] += 1.0e6;
  feed(&biases, 27, spoiled);
  CHECK(std::abs(biases.offset_m(System::kGps, '5') - 300.0) < 2.0);
}

TEST_CASE("a delay and what it contains of the ionosphere are filtered alike") {
  ReceiverCodeBiases biases;
  biases.set_reference(System::kGps, '1');
  // A delay of 5 m, and 2.4 m of the ionosphere at the zenith, while the satellites sink; then the
  // model follows by 1.4 m.
  double zenith = 2.4;
  for (int epoch = 0; epoch < 300; ++epoch) {
    if (epoch == 200) {
      zenith = 1.0;
      biases.step_ionosphere_model(1.4);
    }
    biases.open(kBeginOfWeek.plus_seconds(epoch));
    InterBandDifferences differences;
    for (const double high : {1.0, 1.2, 1.3, 1.7, 2.4}) {
      const double mapping = high + 1e-3 * epoch;
      differences.ionosphere_mappings.push_back(mapping);
      differences.values_m.push_back(5.0 + zenith * mapping);
    }
    biases.update(System::kGps, '5', differences);
    CHECK(biases.offset_m(System::kGps, '5') -
              zenith * biases.ionosphere_mapping(System::kGps, '5') ==
          Approx(5.0));
  }
  CHECK(biases.ionosphere_mapping(System::kGps, '5') > 1.4);
  CHECK(biases.ionosphere_mapping(System::kGps, '1') == 0.0);
}
