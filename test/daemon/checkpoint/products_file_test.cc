// Broadcast products survive a restart, and a damaged file is never half used.
#include "daemon/checkpoint/products_file.h"

#include <algorithm>
#include <span>
#include <vector>

#include "daemon/config/load_config.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/temporary_file.h"

using namespace leonav;
using test::write_file;

namespace {

SignalBias bias_of(std::uint16_t number, double bias_m, double received_s, double from_s = 0.0) {
  SignalBias bias;
  bias.satellite = {System::kGalileo, number};
  bias.code = {'5', 'Q'};
  bias.time = test::kSkyEpoch.plus_seconds(received_s);
  bias.bias_m = bias_m;
  if (from_s != 0.0) {
    bias.valid_from = test::kSkyEpoch.plus_seconds(from_s);
    bias.valid_until = bias.valid_from.plus_seconds(86400.0);
  }
  return bias;
}

// More than a store holds.
std::vector<SignalBias> biases_of_every_leo_satellite(double received_s) {
  std::vector<SignalBias> many;
  for (std::uint16_t number = 1; number <= kHighestNumber[index_of(System::kLeo)]; ++number) {
    for (char attribute = 'A'; attribute <= 'Z'; ++attribute) {
      many.push_back(bias_of(number, 1.0, received_s));
      many.back().satellite.system = System::kLeo;
      many.back().code = {'1', attribute};
    }
  }
  return many;
}

BroadcastProducts some_products() {
  BroadcastProducts products;
  Decoder decoder;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(2.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        Ephemeris ephemeris;
                        if (channel == Channel::kEphemeris &&
                            decoder.decode(bytes, &ephemeris).fault == InputFault::kNone)
                          products.ephemerides.push_back(ephemeris);
                      });
  products.biases = {bias_of(3, 1.5, 0.0), bias_of(4, -0.25, 0.0, 10.0), bias_of(1, 2.0, 5.0)};
  products.ionosphere = KlobucharModel();
  products.ionosphere->alpha[0] = 1e-8;
  return products;
}

std::string text_of_file(const BroadcastProducts& products) {
  static ProductsText text;  // as for a file that is written again
  return text.of(products);
}

}  // namespace

TEST_CASE("products are read as they were written") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = products_path(folder.beside("checkpoint.yaml"));
  CHECK_FALSE(load_products(path));
  const BroadcastProducts products = some_products();
  REQUIRE(products.ephemerides.size() > 4);
  const std::string text = text_of_file(products);
  write_file(path, text);
  const auto read = load_products(path);
  REQUIRE(read);
  REQUIRE(read->ephemerides.size() == products.ephemerides.size());
  CHECK(read->ephemerides[2].satellite == products.ephemerides[2].satellite);
  CHECK(read->ephemerides[2].m0 == products.ephemerides[2].m0);
  CHECK(read->ionosphere->alpha[0] == 1e-8);
  REQUIRE(read->biases.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(read->biases[i].satellite == products.biases[i].satellite);
    CHECK(read->biases[i].code == products.biases[i].code);
    CHECK(read->biases[i].bias_m == products.biases[i].bias_m);
    CHECK(read->biases[i].time == products.biases[i].time);
    CHECK(read->biases[i].valid_from == products.biases[i].valid_from);
    CHECK(read->biases[i].valid_until == products.biases[i].valid_until);
  }
  CHECK(text_of_file(*read) == text);
}

TEST_CASE("a file with any byte changed, cut anywhere, or too long is refused as a whole") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("c.products");
  BroadcastProducts few = some_products();
  few.ephemerides.resize(2);
  REQUIRE(few.biases.size() == 3);
  const std::string text = text_of_file(few);
  std::size_t refused = 0, tried = 0;
  const auto attempt = [&](const std::string& damaged) {
    write_file(path, damaged);
    ++tried;
    try {
      load_products(path);
    } catch (const ConfigError& error) {
      refused += std::string(error.what()).find(path) == 0 ? 1 : 0;
    }
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    attempt(damaged);
    if (i % 7 == 0) attempt(text.substr(0, i));
  }
  attempt(std::string(2'000'000, 'x'));
  // The number of events, which no sum covers, is the least there is.
  std::string least = text;
  const std::size_t number = least.rfind("\xED\xA1\xDA\x01") + 4;
  least.replace(number, 8, std::string("\x80") + std::string(7, '\0'));
  attempt(least);
  CHECK(refused == tried);
}

TEST_CASE("the newest elements of a satellite replace those before, of each message by itself") {
  ProductStore store;
  BroadcastProducts taken;
  CHECK_FALSE(store.take(&taken));
  Ephemeris ephemeris;
  ephemeris.satellite = {System::kGalileo, 5};
  ephemeris.message = NavigationMessage::kGalileoInav;
  store.keep(ephemeris);
  ephemeris.issue = 7;
  store.keep(ephemeris);
  ephemeris.message = NavigationMessage::kGalileoFnav;
  store.keep(ephemeris);
  REQUIRE(store.take(&taken));
  REQUIRE(taken.ephemerides.size() == 2);
  CHECK(taken.ephemerides[0].issue == 7);
  CHECK_FALSE(store.take(&taken));
}

TEST_CASE("a signal's newest bias replaces the one before, and the next day's comes beside it") {
  ProductStore store;
  BroadcastProducts taken;
  const auto keep = [&](const SignalBias& bias) { store.keep(std::span(&bias, 1)); };
  keep(bias_of(3, 1.0, 0.0));
  keep(bias_of(3, 2.0, 60.0));
  keep(bias_of(5, 3.0, 70.0));
  REQUIRE(store.take(&taken));
  REQUIRE(taken.biases.size() == 2);
  CHECK(taken.biases[0].bias_m == 2.0);
  CHECK(taken.biases[1].bias_m == 3.0);
  CHECK_FALSE(store.take(&taken));
}

// What a store holds that has been given these one after the other, as values in order.
static std::vector<double> kept_of(const std::vector<SignalBias>& biases) {
  ProductStore store;
  for (const SignalBias& bias : biases) store.keep(std::span(&bias, 1));
  BroadcastProducts taken;
  REQUIRE(store.take(&taken));
  std::vector<double> values;
  for (const SignalBias& bias : taken.biases) values.push_back(bias.bias_m);
  std::sort(values.begin(), values.end());
  return values;
}

TEST_CASE("of a signal's biases those stay that are in force and that begin next, in any order") {
  constexpr double kDay_s = 86400.0;
  const auto of_day = [](int day, double received_s) {
    return bias_of(7, day, received_s, kDay_s * day);
  };
  const double now_s = 1.2 * kDay_s;
  std::vector<int> days = {1, 2, 3};
  do {
    std::vector<SignalBias> biases;
    for (const int day : days) biases.push_back(of_day(day, now_s));
    CHECK(kept_of(biases) == std::vector{1.0, 2.0});
    biases.push_back(of_day(3, now_s + kDay_s));  // the first day has ended
    biases.push_back(of_day(1, now_s + kDay_s));
    CHECK(kept_of(biases) == std::vector{2.0, 3.0});
  } while (std::next_permutation(days.begin(), days.end()));
}

TEST_CASE("of a signal's biases without an end the newest stay, whatever their beginnings") {
  std::vector<SignalBias> biases;
  for (const double begins_s : {30.0, 20.0, 10.0}) {
    biases.push_back(bias_of(9, begins_s, 100.0 - begins_s, begins_s));
    biases.back().valid_until = GpsTime();
  }
  CHECK(kept_of(biases) == std::vector{10.0, 20.0});
}

TEST_CASE("biases of carriers and impossible ones are not kept, nor more than there is room for") {
  ProductStore store;
  BroadcastProducts taken;
  SignalBias phase = bias_of(3, 1.0, 0.0), far = phase, without_time = phase;
  phase.kind = BiasKind::kPhase;
  far.bias_m = 2.0 * kLargestBias_m;
  without_time.time = GpsTime();
  store.keep(std::vector{phase, far, without_time});
  CHECK_FALSE(store.take(&taken));
  const std::vector<SignalBias> many = biases_of_every_leo_satellite(0.0);
  REQUIRE(many.size() > ProductStore::kMostBiases);
  store.keep(many);
  REQUIRE(store.take(&taken));
  CHECK(taken.biases.size() == ProductStore::kMostBiases);
  // They take two messages, and come back from the file.
  CHECK(first_message_of(taken.biases).size() == kMaxBiases);
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("c.products");
  write_file(path, text_of_file(taken));
  const auto read = load_products(path);
  REQUIRE(read);
  CHECK(read->biases.size() == taken.biases.size());
  CHECK(text_of_file(*read) == text_of_file(taken));
}

TEST_CASE("a full store keeps the biases that hold, and takes others once these have ended") {
  ProductStore store;
  BroadcastProducts taken;
  std::vector<SignalBias> many = biases_of_every_leo_satellite(0.0);
  many.resize(ProductStore::kMostBiases);
  const auto keep = [&](std::uint16_t number, double received_s) {
    const SignalBias bias = bias_of(number, 2.0, received_s);
    store.keep(std::span(&bias, 1));
  };
  const auto count_of_galileo = [&] {
    REQUIRE(store.take(&taken));
    return std::count_if(taken.biases.begin(), taken.biases.end(), [](const SignalBias& bias) {
      return bias.satellite.system == System::kGalileo;
    });
  };
  store.keep(many);
  keep(1, 60.0);
  CHECK(count_of_galileo() == 0);
  CHECK(taken.biases.size() == ProductStore::kMostBiases);
  // Half of them are sent again.
  for (SignalBias& bias : many) bias.time = bias.time.plus_seconds(3600.0);
  const std::span repeated = std::span(many).first(many.size() / 2);
  store.keep(repeated);
  keep(1, kLongestBiasAge_s + 60.0);
  keep(2, kLongestBiasAge_s + 61.0);
  CHECK(count_of_galileo() == 2);
  CHECK(taken.biases.size() == repeated.size() + 2);
}
