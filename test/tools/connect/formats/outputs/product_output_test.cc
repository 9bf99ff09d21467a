// Models, biases and elements of files are sent once they hold, and again and again, a few at a
// time; and what of them holds is told.
#include "tools/connect/formats/outputs/product_output.h"

#include <map>
#include <set>

#include "drivers/lcm/decode.h"
#include "support/catch.h"
#include "tools/connect/formats/outputs/product_watch.h"

namespace leonav {
namespace {

const GpsTime kNow = GpsTime::from_week_and_tow(2136, 345'600.0);

struct Receiver : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    ++counts[channel];
    Decoder decoder;
    if (channel == Channel::kAntenna) {
      AntennaPattern pattern;
      REQUIRE(decoder.decode(bytes, &pattern).fault == InputFault::kNone);
      antennas.push_back(pattern);
    } else if (channel == Channel::kBiases) {
      SignalBiases read;
      const DecodeResult result = decoder.decode(bytes, &read);
      REQUIRE(result.fault == InputFault::kNone);
      REQUIRE(result.element_faults == 0);
      biases.insert(biases.end(), read.begin(), read.end());
    } else {
      Ephemeris read;
      REQUIRE(channel == Channel::kEphemeris);
      REQUIRE(decoder.decode(bytes, &read).fault == InputFault::kNone);
      elements.push_back(read);
    }
  }
  std::map<Channel, int> counts;
  std::vector<AntennaPattern> antennas;
  std::vector<SignalBias> biases;
  std::vector<Ephemeris> elements;
};

AntennaPattern antenna(std::uint16_t number, GpsTime from = {}, GpsTime until = {}) {
  AntennaPattern pattern;
  pattern.satellite = {System::kGps, number};
  pattern.band = '1';
  pattern.valid_from = from;
  pattern.valid_until = until;
  pattern.offset_m.z() = 1.5;
  return pattern;
}

SignalBias bias(std::uint16_t number, char attribute, GpsTime from, GpsTime until) {
  SignalBias one;
  one.satellite = {System::kGps, number};
  one.code = {'1', attribute};
  one.bias_m = 0.5;
  one.valid_from = from;
  one.valid_until = until;
  return one;
}

Ephemeris low(std::uint16_t number, double toe_s) {
  Ephemeris e;
  e.satellite = {System::kLeo, number};
  e.toe = e.toc = kNow.plus_seconds(toe_s);
  e.transmission_time = e.toe.plus_seconds(-300.0);
  e.sqrt_a = 2700.0;
  e.i0 = 1.0;
  return e;
}

}  // namespace

TEST_CASE("Everything that holds is sent within seconds, and then once in an interval",
          "[connect]") {
  auto products = std::make_shared<FileProducts>();
  for (std::uint16_t number = 1; number <= 50; ++number) {
    products->antennas.push_back(antenna(number));
  }
  products->antennas.push_back(antenna(51, {}, kNow.plus_seconds(-1.0)));
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 30.0, &output);
  CHECK(sender.send_due(kNow) == ProductOutput::kMostAtOnce);
  CHECK(sender.send_due(kNow.plus_seconds(0.05)) == 0);
  double at = 0.0;
  for (; at < 0.35; at += 0.1) sender.send_due(kNow.plus_seconds(at));
  std::set<std::uint16_t> satellites;
  for (const AntennaPattern& one : receiver.antennas) satellites.insert(one.satellite.number);
  CHECK(satellites.size() == 50);  // the one whose validity has ended is not among them
  CHECK(sender.holding().satellite_antennas.holding == 50);

  // A round takes the interval, and nothing comes at once.
  const std::size_t before = receiver.antennas.size();
  int most = 0;
  for (; at < 30.3; at += 0.1) most = std::max(most, sender.send_due(kNow.plus_seconds(at)));
  satellites.clear();
  for (std::size_t i = before; i < receiver.antennas.size(); ++i) {
    satellites.insert(receiver.antennas[i].satellite.number);
  }
  CHECK(satellites.size() == 50);
  CHECK(receiver.antennas.size() - before <= 51);
  CHECK(most <= 2);
}

TEST_CASE("With an interval of zero each is sent once, also those that begin to hold later",
          "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->antennas = {antenna(1), antenna(2, kNow.plus_seconds(100.0))};
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 0.0, &output);
  for (double at = 0.0; at < 99.0; at += 1.0) sender.send_due(kNow.plus_seconds(at));
  CHECK(receiver.antennas.size() == 1);
  for (double at = 99.0; at < 200.0; at += 1.0) sender.send_due(kNow.plus_seconds(at));
  CHECK(receiver.antennas.size() == 2);
}

TEST_CASE("A receiver whose time was set back does not silence what is due", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->antennas = {antenna(1)};
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 30.0, &output);
  sender.send_due(kNow);
  for (double at = 0.0; at <= 40.0; at += 1.0) sender.send_due(kNow.plus_seconds(-1e6 + at));
  CHECK(receiver.antennas.size() >= 2);
}

TEST_CASE("Biases come a minute before they hold, and not after", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  const GpsTime change = kNow.plus_seconds(200.0);
  products->biases = {bias(1, 'C', kNow.plus_seconds(-1000.0), change),
                      bias(1, 'C', change, kNow.plus_seconds(5000.0))};
  for (std::uint16_t number = 1; number <= 63; ++number) {
    products->biases.push_back(bias(number, 'W', kNow.plus_seconds(-1000.0), change));
  }
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 30.0, &output);
  CHECK(sender.send_due(kNow) == 2);  // 64 of one validity, 40 of them in a message
  CHECK(receiver.biases.size() == 64);
  CHECK(receiver.biases.front().time == kNow);
  CHECK(sender.holding().biases.holding == 64);
  const auto later = [&] {
    return std::count_if(receiver.biases.begin(), receiver.biases.end(),
                         [&](const SignalBias& one) { return one.valid_from == change; });
  };
  for (double at = 1.0; at < 140.0; at += 1.0) sender.send_due(kNow.plus_seconds(at));
  CHECK(later() == 0);
  sender.send_due(kNow.plus_seconds(140.0));
  CHECK(later() == 1);
  receiver.biases.clear();
  for (double at = 200.0; at < 300.0; at += 1.0) sender.send_due(kNow.plus_seconds(at));
  CHECK(later() == static_cast<std::ptrdiff_t>(receiver.biases.size()));
}

TEST_CASE("Of elements the two newest issues of a satellite are sent, none before its time",
          "[connect]") {
  auto products = std::make_shared<FileProducts>();
  for (double toe = -1800.0; toe <= 1800.0; toe += 600.0) {
    products->leo_elements.push_back(low(7, toe));
  }
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 30.0, &output);
  sender.send_due(kNow);
  std::set<double> reference_times;
  for (const Ephemeris& one : receiver.elements) {
    reference_times.insert(seconds_between(one.toe, kNow));
  }
  CHECK(reference_times == std::set<double>{-600.0, 0.0});
  receiver.elements.clear();
  for (double at = 300.0; at < 340.0; at += 1.0) sender.send_due(kNow.plus_seconds(at));
  reference_times.clear();
  for (const Ephemeris& one : receiver.elements) {
    CHECK(one.transmission_time <= kNow.plus_seconds(340.0));
    reference_times.insert(seconds_between(one.toe, kNow));
  }
  CHECK(reference_times == std::set<double>{0.0, 600.0});
}

TEST_CASE("Times that interleave do not make the repeats more frequent", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  for (std::uint16_t number = 1; number <= 10; ++number) {
    products->antennas.push_back(antenna(number));
  }
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 10.0, &output);
  // Samples at 100 Hz, epochs at 10 Hz that come 0.2 s late, and a stream whose time is a day
  // wrong.
  for (int i = 0; i < 10'000; ++i) {
    const double at = 0.01 * i;
    sender.send_due(kNow.plus_seconds(at));
    if (i % 10 == 0) sender.send_due(kNow.plus_seconds(at - 0.2));
    if (i % 100 == 0) sender.send_due(kNow.plus_seconds(at - 86'400.0));
    if (i % 100 == 50) sender.send_due(kNow.plus_seconds(at + 100.0 * 86'400.0));
  }
  CHECK(receiver.antennas.size() >= 105);
  CHECK(receiver.antennas.size() <= 115);
  CHECK(std::abs(seconds_between(sender.time(), kNow.plus_seconds(100.0))) < 0.2);
}

TEST_CASE("A row of elements that repeats a set is not sent beside it", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->leo_elements = {low(7, -600.0), low(7, 0.0), low(7, 0.0), low(7, 0.0)};
  Receiver receiver;
  MessageOutput output(&receiver);
  ProductOutput sender(products, 0.0, &output);
  CHECK(sender.send_due(kNow) == 2);
  std::set<double> reference_times;
  for (const Ephemeris& one : receiver.elements) {
    reference_times.insert(seconds_between(one.toe, kNow));
  }
  CHECK(reference_times == std::set<double>{-600.0, 0.0});
}

namespace {

struct ProductWatchRig {
  explicit ProductWatchRig(std::shared_ptr<FileProducts> products)
      : sender(products, 30.0, &output) {}
  // Returns what is told in some seconds, in lines; warnings begin with "!".
  std::string run(double begin_s, double end_s) {
    std::string lines;
    for (double at = begin_s; at < end_s; at += 1.0) {
      sender.send_due(kNow.plus_seconds(at));
      for (const auto& [is_warning, text] : watch.look(sender.holding(), sender.time())) {
        lines += (is_warning ? "!" : "") + text + "\n";
      }
    }
    return lines;
  }
  Receiver receiver;
  MessageOutput output{&receiver};
  ProductOutput sender;
  ProductWatch watch;
};

AntennaPattern receiver_antenna() {
  AntennaPattern pattern = antenna(1);
  pattern.is_receiver = true;
  pattern.satellite = {};
  return pattern;
}

}  // namespace

TEST_CASE("What holds is told at the first time, and a warning when satellites' models have ended",
          "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->antennas = {receiver_antenna(), antenna(1, {}, kNow.plus_seconds(100.0)), antenna(2)};
  products->antennas[2].valid_until = kNow.plus_seconds(50.0);
  products->biases = {bias(1, 'C', {}, {})};
  ProductWatchRig rig(products);
  CHECK(rig.watch.look(rig.sender.holding(), rig.sender.time()).empty());  // no time yet
  CHECK_THAT(rig.run(0.0, 100.0), Catch::Contains("1 antenna models of the receiver and 2 of") &&
                                      Catch::Contains("biases of 1 signals, 0 sets") &&
                                      !Catch::Contains("!"));
  // The receiver's model holds for good, which does not help.
  CHECK(rig.run(100.0, 104.0).empty());
  const std::string told = rig.run(104.0, 200.0);
  CHECK_THAT(told, Catch::StartsWith("!corrections.antenna_models, of satellites: none holds") &&
                       Catch::Contains(text_of(kNow.plus_seconds(104.0)) + " GPS time"));
  CHECK(std::count(told.begin(), told.end(), '\n') == 1);
}

TEST_CASE("Products that begin later are no fault, also where the receiver has no date yet",
          "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->biases = {bias(1, 'C', kNow, kNow.plus_seconds(1000.0))};
  ProductWatchRig rig(products);
  const std::string early = rig.run(-1e8, -1e8 + 20.0);
  CHECK_THAT(early, !Catch::Contains("!") && Catch::Contains("corrections.biases: none holds at") &&
                        Catch::Contains("the first begins at"));
  CHECK_THAT(rig.run(0.0, 20.0), Catch::Equals("corrections.biases: 1 of 1 hold at " +
                                               text_of(kNow.plus_seconds(9.0)) + " GPS time\n"));
  CHECK(rig.run(20.0, 999.0).empty());
  CHECK_THAT(rig.run(999.0, 1100.0), Catch::StartsWith("!corrections.biases"));
  CHECK_THAT(rig.run(500.0, 600.0), Catch::Contains("1 of 1 hold"));
}

TEST_CASE("A wrong time for some seconds is not blamed on the files", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->biases = {bias(1, 'C', kNow.plus_seconds(-1000.0), kNow.plus_seconds(1000.0))};
  ProductWatchRig rig(products);
  const std::string told = rig.run(1e8, 1e8 + 4.0) + rig.run(0.0, 100.0);
  CHECK(std::count(told.begin(), told.end(), '!') == 0);
}

TEST_CASE("The end of elements is told when leonavd uses them no more", "[connect]") {
  auto products = std::make_shared<FileProducts>();
  products->leo_elements = {low(7, 0.0)};
  ProductWatchRig rig(products);
  CHECK_THAT(rig.run(0.0, 900.0), !Catch::Contains("!"));
  CHECK_THAT(rig.run(901.0, 910.0), Catch::StartsWith("!leo_elements: none holds any more"));
  // A longer age can be configured there.
  rig.receiver.elements.clear();
  rig.run(910.0, 1000.0);
  CHECK(rig.receiver.elements.size() >= 2);
}

}  // namespace leonav
