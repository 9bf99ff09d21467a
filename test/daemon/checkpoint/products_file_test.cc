// Broadcast products survive a restart, and a damaged file is never half used.
#include "daemon/checkpoint/products_file.h"

#include <fstream>

#include "daemon/config/load_config.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"
#include "support/drive_inputs.h"
#include "support/temporary_file.h"

using namespace leonav;

namespace {

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
  products.ionosphere = KlobucharModel();
  products.ionosphere->alpha[0] = 1e-8;
  return products;
}

std::string text_of_file(const BroadcastProducts& products) {
  static ProductsText text;  // as for a file that is written again
  return text.of(products);
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

TEST_CASE("products are read as they were written") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = products_path(folder.beside("checkpoint.yaml"));
  CHECK_FALSE(load_products(path));
  const BroadcastProducts products = some_products();
  REQUIRE(products.ephemerides.size() > 4);
  const std::string text = text_of_file(products);
  write(path, text);
  const auto read = load_products(path);
  REQUIRE(read);
  REQUIRE(read->ephemerides.size() == products.ephemerides.size());
  CHECK(read->ephemerides[2].satellite == products.ephemerides[2].satellite);
  CHECK(read->ephemerides[2].m0 == products.ephemerides[2].m0);
  CHECK(read->ionosphere->alpha[0] == 1e-8);
  CHECK(text_of_file(*read) == text);
}

TEST_CASE("a file with any byte changed, cut anywhere, or too long is refused as a whole") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("c.products");
  BroadcastProducts few = some_products();
  few.ephemerides.resize(2);
  const std::string text = text_of_file(few);
  std::size_t refused = 0, tried = 0;
  const auto attempt = [&](const std::string& damaged) {
    write(path, damaged);
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
