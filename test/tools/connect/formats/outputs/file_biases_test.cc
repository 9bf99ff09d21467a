// Biases of files give way to those of correction services, also where the files' came first and
// where one service takes the place of another.
#include "tools/connect/formats/outputs/file_biases.h"

#include <memory>
#include <string>

#include "core/gnss/signals/signal.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"
#include "tools/connect/formats/outputs/correction_output.h"
#include "tools/connect/formats/outputs/product_output.h"

namespace leonav {
namespace {

const GpsTime kBiasesStart = GpsTime::from_week_and_tow(2200, 345'600.0);
GpsTime bias_time(double s) { return kBiasesStart.plus_seconds(s); }
constexpr SatelliteId kG01{System::kGps, 1}, kG02{System::kGps, 2};

// What leonavd knows of the biases that were published.
struct BiasListener : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    if (channel != Channel::kBiases) return;
    SignalBiases read;
    REQUIRE(Decoder().decode(bytes, &read).fault == InputFault::kNone);
    for (const SignalBias& one : read) {
      CHECK(store.add(one));
      ++count;
    }
  }
  // Of the ionosphere-free pair in L1 C/A and `second`; 0: none.
  double pair_m(SatelliteId satellite, double time_s, const char* second) const {
    const auto delay = store.code_delay(satellite, bias_time(time_s), *signal_from_string("1C"),
                                        *signal_from_string(second));
    return delay ? delay->delay_m : 0.0;
  }
  SignalBiasStore store;
  int count = 0;
};

SignalBias of_file(SatelliteId satellite, const char* code, GpsTime from = bias_time(-1000.0),
                   GpsTime until = bias_time(200'000.0)) {
  return {satellite, *signal_from_string(code), BiasKind::kCode, {}, 100.0, from, until};
}

SsrMessage clocks_of_service(double time_s, SatelliteId satellite) {
  SsrMessage m;
  m.kind = SsrKind::kOrbitAndClock;
  m.system = satellite.system;
  m.time = bias_time(time_s);
  m.update_interval_s = 1.0;
  SsrSatellite& one = m.satellites.emplace_back();
  one.satellite = satellite;
  one.orbit = SsrOrbit{17, {}, {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0}};
  one.clock = SsrClock{1.0, 0.0, 0.0};
  return m;
}

SsrMessage biases_of_service(double time_s, SatelliteId satellite,
                             const std::vector<const char*>& codes) {
  SsrMessage m;
  m.kind = SsrKind::kCodeBias;
  m.system = satellite.system;
  m.time = bias_time(time_s);
  SsrSatellite& one = m.satellites.emplace_back();
  one.satellite = satellite;
  for (const char* code : codes) {
    one.code_biases.push_back({*signal_from_string(code), 1.0, false, 0, 0});
  }
  return m;
}

// As the Connector puts them together, with two services.
struct FileBiasRig {
  FileBiasRig(std::vector<SignalBias> of_files, double repeat_s)
      : products(make(std::move(of_files)), repeat_s, &output) {
    output.listen_to_time([this](GpsTime time) { products.send_due(time); });
    shared.on_biases = [this](std::span<const SignalBias> sent) { products.yield_to(sent); };
    for (SatelliteId satellite : {kG01, kG02}) {
      Ephemeris e;
      e.satellite = satellite;
      e.toe = e.toc = kBiasesStart;
      e.issue = 17;
      e.sqrt_a = 5153.7;
      e.eccentricity = 0.01;
      e.i0 = 0.96;
      first.add(e);
    }
  }
  static std::shared_ptr<FileProducts> make(std::vector<SignalBias> of_files) {
    auto made = std::make_shared<FileProducts>();
    made->biases = std::move(of_files);
    return made;
  }
  void wait(double begin_s, double end_s) {
    for (double at = begin_s; at < end_s; at += 1.0) products.send_due(bias_time(at));
  }
  BiasListener listener;
  MessageOutput output{&listener};
  SharedCorrections shared{{}, {}, &output};
  CorrectionOutput first{"first", &shared}, second{"second", &shared};
  ProductOutput products;
};

}  // namespace

TEST_CASE("Biases of files that came first end where a service gives those of a satellite",
          "[connect]") {
  const double repeat_s = GENERATE(0.0, 10.0);
  FileBiasRig rig({of_file(kG01, "1C"), of_file(kG01, "2W"), of_file(kG01, "5Q"),
                   of_file(kG02, "1C"), of_file(kG02, "2W")},
                  repeat_s);
  rig.wait(0.0, 30.0);
  CHECK(rig.listener.pair_m(kG01, 29.0, "2W") == Approx(100.0));
  CHECK(rig.listener.pair_m(kG01, 29.0, "5Q") == Approx(100.0));
  rig.first.take(clocks_of_service(30.0, kG01), bias_time(30.0));
  rig.first.take(biases_of_service(30.0, kG01, {"1C", "2W"}), bias_time(30.0));
  CHECK(rig.listener.pair_m(kG01, 30.0, "2W") == Approx(-1.0));
  CHECK(rig.listener.pair_m(kG01, 30.0, "5Q") == 0.0);  // not of the service and the files
  const int before = rig.listener.count;
  rig.wait(31.0, 100.0);
  CHECK(rig.listener.pair_m(kG01, 100.0, "2W") == Approx(-1.0));
  CHECK(rig.listener.pair_m(kG01, 100.0, "5Q") == 0.0);
  CHECK(rig.listener.pair_m(kG02, 100.0, "2W") == Approx(100.0));
  CHECK((rig.listener.count > before) == (repeat_s > 0.0));  // those of the other satellite
  // The service's end a day after its last ones, and the files' serve again, also without repeats.
  rig.wait(30.0 + 86'401.0, 30.0 + 86'404.0);
  CHECK(rig.listener.pair_m(kG01, 30.0 + 86'404.0, "5Q") == 0.0);  // no time that far away yet
  rig.wait(30.0 + 86'404.0, 30.0 + 86'410.0);
  CHECK(rig.listener.pair_m(kG01, 30.0 + 86'410.0, "5Q") == Approx(100.0));
}

TEST_CASE("Without repeats biases of files are not lost to a service that was there before",
          "[connect]") {
  FileBiasRig rig({of_file(kG01, "1C"), of_file(kG01, "2W")}, 0.0);
  rig.first.take(clocks_of_service(0.0, kG01), bias_time(0.0));
  rig.first.take(biases_of_service(0.0, kG01, {"1C"}), bias_time(0.0));
  rig.wait(0.0, 10.0);
  CHECK_FALSE(rig.listener.store.code_delay(kG01, bias_time(10.0), *signal_from_string("2W")));
  rig.wait(86'401.0, 86'412.0);
  CHECK(rig.listener.pair_m(kG01, 86'412.0, "2W") == Approx(100.0));
}

TEST_CASE("A change of service does not let the files' biases in between", "[connect]") {
  FileBiasRig rig({of_file(kG01, "1C"), of_file(kG01, "2W"), of_file(kG01, "5Q")}, 5.0);
  rig.second.take(clocks_of_service(0.0, kG01), bias_time(0.0));
  rig.second.take(biases_of_service(0.0, kG01, {"1C", "2W", "5Q"}), bias_time(0.0));
  rig.wait(0.0, 20.0);
  CHECK(rig.listener.pair_m(kG01, 20.0, "5Q") == Approx(-1.0));
  // The second one pauses. The first one gives no 5Q, whose end comes with the change.
  rig.first.take(biases_of_service(40.0, kG01, {"1C", "2W"}), bias_time(40.0));
  rig.first.take(clocks_of_service(40.0, kG01), bias_time(40.0));
  REQUIRE(rig.shared.services.changes() == 1);
  rig.wait(40.0, 100.0);
  CHECK(rig.listener.pair_m(kG01, 100.0, "2W") == Approx(-1.0));
  CHECK(rig.listener.pair_m(kG01, 100.0, "5Q") == 0.0);
}

TEST_CASE("Where the next service has no biases of a satellite, the files' serve it", "[connect]") {
  FileBiasRig rig({of_file(kG01, "1C"), of_file(kG01, "2W")}, 5.0);
  rig.second.take(clocks_of_service(0.0, kG01), bias_time(0.0));
  rig.second.take(biases_of_service(0.0, kG01, {"1C", "2W"}), bias_time(0.0));
  rig.first.take(clocks_of_service(40.0, kG01), bias_time(40.0));
  REQUIRE(rig.shared.services.changes() == 1);
  rig.wait(40.0, 60.0);
  CHECK(rig.listener.pair_m(kG01, 60.0, "2W") == Approx(100.0));
}

TEST_CASE("Biases of the next day, sent ahead, end as well", "[connect]") {
  const GpsTime midnight = bias_time(100.0);
  FileBiases biases_of_files({of_file(kG01, "2W", bias_time(-1000.0), midnight),
                              of_file(kG01, "2W", midnight, bias_time(5000.0))});
  SignalBiasStore store;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const SignalBias& one : biases_of_files.take(i, bias_time(50.0), false)) store.add(one);
  }
  const SignalCode code = *signal_from_string("2W");
  CHECK(store.code_delay(kG01, bias_time(200.0), code));
  SignalBias service = of_file(kG01, "1C", {}, {});
  service.time = bias_time(60.0);
  const auto ends = biases_of_files.yield_to({&service, 1}, bias_time(60.0));
  REQUIRE(ends.size() == 2);
  for (const SignalBias& end : ends) CHECK(store.add(end));
  CHECK_FALSE(store.code_delay(kG01, bias_time(60.0), code));
  CHECK_FALSE(store.code_delay(kG01, bias_time(200.0), code));
  CHECK(biases_of_files.yield_to({&service, 1}, bias_time(61.0)).empty());  // once
  CHECK_FALSE(biases_of_files.is_whole(0));
}

}  // namespace leonav
