// Variances of a satellite's code as pair and as single frequencies, against the sigmas that
// code_measurement() gives to these very codes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/square.h"
#include "core/gnss/preprocessing/internal/code_correction.h"
#include "core/gnss/preprocessing/preprocess.h"
#include "core/gnss/propagation/ionosphere.h"
#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "support/sky/simulated_sky.h"

namespace leonav {
namespace {

using test::kSkyEpoch;

struct CodeCase {
  System system;
  std::vector<SignalCode> bands;
  std::size_t second;  // of the pair, beside the first
  WeightModel weights;
  double elevation;
};

const CodeCase kCodeCases[] = {
    {System::kGps, {{'1', 'C'}, {'2', 'W'}}, 1, WeightModel::kElevation, 1.0},
    {System::kGps, {{'1', 'C'}, {'5', 'Q'}, {'2', 'W'}}, 2, WeightModel::kElevation, 0.3},
    {System::kGalileo, {{'1', 'C'}, {'5', 'Q'}, {'7', 'Q'}}, 1, WeightModel::kCn0, 0.5},
    {System::kLeo, {{'1', 'C'}, {'2', 'W'}}, 1, WeightModel::kSine, 0.3},
};

struct Codes {
  GnssConfig config = default_gnss_config();
  KlobucharModel klobuchar;
  std::vector<SignalObservation> signals;
  SatelliteInView view;
  Eigen::Vector3d p_e = to_ecef({0.69, 0.14, 300.0});

  explicit Codes(const CodeCase& of) {
    config.weight_model = of.weights;
    view.satellite = {of.system, 7};
    view.source = OrbitSource::kBroadcast;
    view.at_antenna = true;
    view.elevation = of.elevation;
    view.azimuth = 2.0;
    view.p_e = 1.2 * p_e + Eigen::Vector3d(0.0, 2e7, 0.0);
    for (const SignalCode code : of.bands) {
      SignalObservation signal;
      signal.satellite = view.satellite;
      signal.code = code;
      signal.pseudorange_m = 2.2e7;
      signal.cn0_dbhz = code.band == '1' ? 41.0 : 36.0;
      signals.push_back(signal);
    }
  }
  DelayContext context(bool has_position = true) const {
    return delay_context(config, klobuchar, kSkyEpoch,
                         has_position ? p_e : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
  // The code of signal `i`, with signal `second` unless that is 0.
  Measurement code(std::size_t i, std::size_t second = 0) {
    return code_measurement(context(), signals[i], second == 0 ? nullptr : &signals[second],
                            nullptr, 1, &view);
  }
  // What the codes' noise adds to the variance.
  double noise(std::size_t i, std::size_t second = 0) {
    const double with = square(code(i, second).sigma);
    double& sigma = config.systems[index_of(view.satellite.system)].sigma.code_m;
    const double configured = std::exchange(sigma, 0.0);
    const double without = square(code(i, second).sigma);
    sigma = configured;
    return with - without;
  }
  CodeVariances variances(std::size_t second, bool has_position = true) const {
    std::vector<const SignalObservation*> bands;
    for (const SignalObservation& signal : signals) bands.push_back(&signal);
    return code_variances(context(has_position), bands, signals[second], view);
  }
};

TEST_CASE(
    "variances of a code's combinations are those of the codes that it would be measured by") {
  const CodeCase& of = kCodeCases[GENERATE(range(0, 4))];
  CAPTURE(of.system, of.second);
  Codes codes(of);
  codes.klobuchar.valid = GENERATE(false, true);
  codes.klobuchar.alpha = {2e-8, 1e-8, -6e-8, -6e-8};
  codes.klobuchar.beta = {1e5, 6e4, -2e5, -1e5};
  const CodeVariances variances = codes.variances(of.second);
  CHECK(variances.pair_noise == Approx(codes.noise(0, of.second)).epsilon(1e-6));
  double information = 0.0;
  for (std::size_t i = 0; i < codes.signals.size(); ++i) information += 1.0 / codes.noise(i);
  CHECK(variances.single_noise == Approx(1.0 / information).epsilon(1e-6));
  // Of a single frequency nothing else lasts where the orbit is perfect.
  REQUIRE(codes.view.orbit_sigma_m == 0.0);
  CHECK(variances.ionosphere == Approx(square(codes.code(0).correlated_sigma)));
  CHECK(variances.pair_noise > 5.0 * variances.single_noise);
}

// The slant of a ray in the shell at 350 km, by the triangle of centre, receiver and the point
// where the ray pierces the shell.
double slant_in_shell(double elevation) {
  constexpr double kEarth = 6371.0, kShell = 6721.0;
  const Eigen::Vector2d receiver(0.0, kEarth), ray(std::cos(elevation), std::sin(elevation));
  double near = 0.0, far = 5000.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (near + far);
    ((receiver + middle * ray).norm() < kShell ? near : far) = middle;
  }
  return 1.0 / (receiver + near * ray).normalized().dot(ray);
}

TEST_CASE("what the ionosphere's model leaves in common is half of the variance, by the slant") {
  const CodeCase& of = kCodeCases[GENERATE(range(0, 4))];
  CAPTURE(of.system, of.elevation);
  Codes codes(of);
  codes.klobuchar = {
      .alpha = {2e-8, 1e-8, -6e-8, -6e-8}, .beta = {1e5, 6e4, -2e5, -1e5}, .valid = true};
  for (std::size_t i = 0; i < codes.signals.size(); ++i) {
    const Measurement code = codes.code(i);
    const double f = BandPlan().frequency_hz(of.system, codes.signals[i].code.band);
    const IonosphereError& common = code.ionosphere;
    CHECK(common.mapping ==
          Approx(square(1575.42e6 / f) * slant_in_shell(of.elevation)).epsilon(1e-6));
    CHECK(common.variance == Approx(0.5 * square(code.correlated_sigma)));
    CHECK(square(common.mapping * common.zenith_sigma) == Approx(common.variance));
    CHECK(code.own_variance() == Approx(square(code.sigma) - common.variance));
    CHECK(code.own_correlated_variance() == Approx(0.5 * square(code.correlated_sigma)));
  }
  const Measurement pair = codes.code(0, of.second);
  CHECK(pair.ionosphere.mapping == 0.0);
  CHECK(pair.own_variance() == square(pair.sigma));
}

TEST_CASE("a code contains of the ionosphere what the delay of its band has not taken out") {
  Codes codes({System::kGps, {{'1', 'C'}, {'5', 'Q'}}, 1, WeightModel::kElevation, 0.3});
  const double slant = slant_in_shell(codes.view.elevation);
  const double factor = square(1575.42 / 1176.45);
  constexpr double kMedian = 1.4;
  ReceiverCodeBiases biases;
  biases.open(kSkyEpoch);
  biases.set_reference(System::kGps, '1');
  const bool clock_of_pair = GENERATE(false, true);
  // gamma of the pair: -1 / (factor - 1).
  if (clock_of_pair) biases.set_partner(System::kGps, '5', -1.0 / (factor - 1.0));
  InterBandDifferences differences;
  for (const double of : {1.1, kMedian, 2.0}) {
    differences.values_m.push_back(7.0 + of);
    differences.ionosphere_mappings.push_back((factor - 1.0) * of);
  }
  biases.update(System::kGps, '5', differences);
  DelayContext context = codes.context();
  context.biases = &biases;
  const auto mapping = [&](std::size_t i) {
    return code_measurement(context, codes.signals[i], nullptr, nullptr, 1, &codes.view)
        .ionosphere.mapping;
  };
  // The clock of the pair has no delay, and a delay that is compared with it contains the median.
  const double of_clock = clock_of_pair ? kMedian : 0.0;
  CHECK(mapping(0) == Approx(slant - of_clock).epsilon(1e-6));
  CHECK(mapping(1) == Approx(factor * slant - (factor - 1.0) * kMedian - of_clock).epsilon(1e-6));
}

TEST_CASE("without a position no variances of a code are known") {
  const CodeVariances variances = Codes(kCodeCases[0]).variances(1, false);
  CHECK(variances.pair_noise == 0.0);
  CHECK(variances.single_noise == 0.0);
  CHECK(variances.ionosphere == 0.0);
}

TEST_CASE("satellites with a pair tell both variances, whatever their codes are combined as") {
  test::SimulatedSky sky;
  sky.add(test::gps_walker());
  test::SimulatedReceiver receiver;
  GnssConfig config = default_gnss_config();
  const auto told = [&](CodeCombination combination) {
    config.code_combination = combination;
    const auto epoch = std::make_unique<MeasurementEpoch>();
    preprocess(test::simulate_epoch(sky, receiver, 0.0), sky.ephemeris_store, config, receiver.p_e,
               epoch.get());
    std::vector<double> noises;
    for (const SatelliteInView& view : epoch->satellites) {
      CHECK((view.code_variances.ionosphere > 0.0) == (view.code_variances.pair_noise > 0.0));
      noises.push_back(view.code_variances.pair_noise);
      noises.push_back(view.code_variances.single_noise);
    }
    return noises;
  };
  const std::vector<double> pairs = told(CodeCombination::kIonosphereFree);
  REQUIRE(pairs.size() >= 12);
  CHECK(std::count_if(pairs.begin(), pairs.end(), [](double v) { return v > 0.0; }) >= 12);
  CHECK(told(CodeCombination::kSingleFrequency) == pairs);
  CHECK(told(CodeCombination::kAutomatic) == pairs);
  receiver.signals.pop_back();
  for (const double noise : told(CodeCombination::kSingleFrequency)) CHECK(noise == 0.0);
}

// Within seconds the slant delay past a LEO satellite changes by centimetres.
TEST_CASE("Dopplers of a LEO satellite are a pair and others are not, however codes are combined") {
  test::SimulatedSky sky;
  sky.add(test::gps_walker());
  sky.add(test::leo_walker());
  const test::SimulatedReceiver receiver;
  GnssConfig config = default_gnss_config();
  for (const CodeCombination combination :
       {CodeCombination::kAutomatic, CodeCombination::kIonosphereFree,
        CodeCombination::kSingleFrequency}) {
    config.code_combination = combination;
    const auto epoch = std::make_unique<MeasurementEpoch>();
    preprocess(test::simulate_epoch(sky, receiver, 0.0), sky.ephemeris_store, config, receiver.p_e,
               epoch.get());
    int of_leo = 0, of_gps = 0;
    for (const Measurement& doppler : epoch->measurements) {
      if (doppler.observable != Observable::kDoppler) continue;
      const bool leo = epoch->satellites[doppler.satellite_index].satellite.system == System::kLeo;
      ++(leo ? of_leo : of_gps);
      CHECK(doppler.second_code.is_set() == leo);
    }
    CHECK(of_leo > 3);
    CHECK(of_gps > 3);
  }
}

}  // namespace
}  // namespace leonav
