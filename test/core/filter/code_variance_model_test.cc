// Inflation of codes' variances where carriers do not keep the position, against the variance of a
// long mean of errors that last.
#include "core/filter/code_variance_model.h"

#include <algorithm>
#include <cmath>

#include "core/filter/synthetic.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

constexpr double kSigma = 5.0, kLastingSigma = 2.0, kLasting_s = 900.0;
constexpr double kInflation = 3.0;  // of what a reflection lasts

// By how much the variance of a long mean of Gauss-Markov errors exceeds that of white ones.
double of_lasting(double time_s, double interval_s) {
  return 1.0 / std::tanh(0.5 * interval_s / time_s);
}

// A receiver of eight satellites, of which so many have an arc that has gone on.
class CodeReceiver {
 public:
  explicit CodeReceiver(std::size_t arcs, double interval_s = 1.0)
      : arcs_(arcs), interval_s_(interval_s) {
    for (std::uint32_t arc = 1; arc <= arcs; ++arc)
      ambiguities_.push_back({arc, {}, 0.0, 0.0, {}, {}, 0});
    step();
  }

  // Updates that keep so much of the position's variance, for long enough.
  void update(double kept) {
    for (int i = 0; i < 1000; ++i) model_.add_update(10.0, 10.0 * kept, interval_s_);
  }
  void add_update(double before, double after, double interval_s) {
    model_.add_update(before, after, interval_s);
  }
  void reset() {
    model_.reset();
    step();
  }
  double gain_variance(double lasting_s = kLasting_s, double ratio = 1.0) {
    return weigh(lasting_s, ratio, 0.0).gain_variance;
  }
  // Returns the variance with which the filter uses a code.
  double use_code(double reflected_walk) {
    FilterMeasurements used;
    used.push_back(weigh(kLasting_s, 1.0, reflected_walk));
    model_.accept(used);
    return used.front().gain_variance;
  }
  const CodeVarianceModel& model() const { return model_; }
  void step() {
    const GpsTime last = kStart.plus_seconds(seconds_);
    seconds_ += interval_s_;
    Generator noise(1);
    epoch_ = measure(kStart.plus_seconds(seconds_), eight_satellites(), {}, 1.0, 1.0, &noise);
    epoch_.measurements.front().sigma = kSigma;
    epoch_.measurements.front().correlated_sigma = kLastingSigma;
    for (std::uint32_t arc = 1; arc <= arcs_; ++arc) {
      Measurement carrier;
      carrier.observable = Observable::kCarrier;
      carrier.satellite_index = static_cast<std::uint16_t>(arc - 1);
      carrier.arc = arc;
      carrier.sigma = 0.01;
      epoch_.measurements.push_back(carrier);
    }
    for (Ambiguity& ambiguity : ambiguities_) ambiguity.last_used = last;
    model_.begin_epoch(epoch_, ambiguities_, last);
  }

 private:
  FilterMeasurement weigh(double lasting_s, double ratio, double reflected_walk) {
    Measurement code = epoch_.measurements.front();
    code.correlation_time_s = lasting_s;
    FilterMeasurement entry;
    entry.variance = kSigma * kSigma;
    model_.weigh(epoch_, code, kInflation, ratio, reflected_walk, &entry);
    return entry;
  }

  std::size_t arcs_;
  double interval_s_, seconds_ = 0.0;
  EkfConfig config_;
  CodeVarianceModel model_{config_};
  Ambiguities ambiguities_;
  MeasurementEpoch epoch_;
};

double expected(double counted_s, double interval_s = 1.0) {
  const double lasting = kLastingSigma * kLastingSigma;
  return kInflation * (kSigma * kSigma - lasting) +
         std::max(kInflation, of_lasting(counted_s, interval_s)) * lasting;
}

TEST_CASE("carriers keep the position while five arcs and more go on") {
  CHECK(CodeReceiver(8).model().carriers_keep_position());
  CHECK(CodeReceiver(5).model().carriers_keep_position());
  CHECK_FALSE(CodeReceiver(4).model().carriers_keep_position());
  CHECK_FALSE(CodeReceiver(2).model().carriers_keep_position());
}

TEST_CASE("arcs have five seconds to go on; where none does, codes hold the position") {
  CodeReceiver none(0);
  for (int second = 0; second < 5; ++second) {
    CHECK(none.model().carriers_keep_position());
    none.step();
  }
  CHECK(none.model().carriers_keep_position());
  none.step();
  CHECK_FALSE(none.model().carriers_keep_position());
  none.reset();
  CHECK(none.model().carriers_keep_position());
  // Epochs after a tunnel have new arcs, which may go on.
  CodeReceiver after_tunnel(0, 20.0);
  CHECK(after_tunnel.model().carriers_keep_position());
  CHECK(none.model().carriers_keep_position());
}

TEST_CASE("a position that is soon forgotten leaves all of a code inflated as its reflections") {
  CodeReceiver receiver(2);
  const double plain = kInflation * kSigma * kSigma;
  CHECK(receiver.gain_variance() == Approx(plain));  // nothing is known of the memory yet
  receiver.update(0.1);
  CHECK(receiver.gain_variance() == Approx(plain));
  receiver.update(0.96);  // 25 s, of which 1.25 s count
  CHECK(receiver.gain_variance() == Approx(plain));
}

TEST_CASE("what lasts is inflated for a twentieth of the position's memory, at most for 20 s") {
  const double interval_s = GENERATE(1.0, 0.2);
  CAPTURE(interval_s);
  CodeReceiver receiver(2, interval_s);
  double before = 0.0;
  for (const double memory_s : {100.0, 200.0, 300.0, 400.0}) {
    receiver.update(1.0 - interval_s / memory_s);
    CAPTURE(memory_s);
    CHECK(receiver.gain_variance() == Approx(expected(memory_s / 20.0, interval_s)).epsilon(1e-3));
    CHECK(receiver.gain_variance() > before);
    before = receiver.gain_variance();
  }
  for (const double memory_s : {500.0, 1000.0, 1e9}) {
    receiver.update(1.0 - interval_s / memory_s);
    CHECK(receiver.gain_variance() == Approx(expected(20.0, interval_s)).epsilon(1e-3));
  }
  receiver.update(1.01);  // an update that has made the position less certain
  CHECK(receiver.gain_variance() == Approx(expected(20.0, interval_s)).epsilon(1e-3));
}

TEST_CASE("what lasts shorter than the memory is inflated for as long as it lasts") {
  CodeReceiver receiver(2);
  receiver.update(0.9999);
  CHECK(receiver.gain_variance(6.0) == Approx(expected(6.0)));
  CHECK(receiver.gain_variance(6000.0, 1e-3) == Approx(expected(6.0)));
  CHECK(receiver.gain_variance(0.0) == Approx(kInflation * kSigma * kSigma));
}

TEST_CASE("without carriers that keep the position no code is scheduled, and with them all are") {
  CodeReceiver few(2), many(8);
  few.update(0.9999);
  many.update(0.9999);
  for (int i = 0; i < 10; ++i) few.step(), many.step();
  CHECK(few.gain_variance() == Approx(expected(20.0)));
  CHECK(many.gain_variance() != Approx(expected(20.0)));
}

TEST_CASE("codes of a satellite whose carrier drifts by a reflection keep more of their weight") {
  // The variance of a code after a minute of them.
  const auto after_minute = [](double reflected_walk) {
    CodeReceiver receiver(8);
    double variance = 0.0;
    for (int i = 0; i < 60; ++i) {
      receiver.step();
      variance = receiver.use_code(reflected_walk);
    }
    return variance;
  };
  const double still = after_minute(0.0), little = after_minute(0.1), much = after_minute(1.0);
  CHECK(little < 0.9 * still);
  CHECK(much < 0.9 * little);
}

TEST_CASE("updates of no interval or of no variance leave the memory as it is") {
  CodeReceiver receiver(2);
  receiver.update(0.99);
  const double before = receiver.gain_variance();
  receiver.add_update(0.0, 0.0, 1.0);
  receiver.add_update(10.0, 1.0, 0.0);
  receiver.add_update(std::nan(""), 1.0, 1.0);
  CHECK(receiver.gain_variance() == before);
  receiver.reset();
  CHECK(receiver.gain_variance() == Approx(kInflation * kSigma * kSigma));
}

}  // namespace
}  // namespace leonav
