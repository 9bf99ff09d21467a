// The files of products that the configuration of leonav-connect names: what is read of them, and
// what a mistake is told as.
#include "tools/connect/product_keys.h"

#include <fstream>
#include <iterator>

#include "daemon/config/load_config.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/connect/connect_config.h"

using Catch::Contains;

namespace leonav {
namespace {

const std::string kStreams = "streams:\n  - {name: a, source: stdin, format: ubx}\n";

std::string seed(const std::string& name) { return LEONAV_SOURCE_DIR "/test/fuzz/corpus/" + name; }

ConnectConfig load_with_stream(const std::string& text) {
  const test::TemporaryFile file("connect.yaml", text + kStreams);
  return load_connect_config(file.path(), {});
}

// The seed's header and its last antenna, which is a receiver's.
std::string receivers_alone() {
  std::ifstream file(seed("antex/three"));
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  const auto begin_of_line = [&](std::size_t at) { return all.rfind('\n', at) + 1; };
  const std::string begin = "START OF ANTENNA";
  return all.substr(0, begin_of_line(all.find(begin))) +
         all.substr(begin_of_line(all.rfind(begin)));
}

std::string error_of(const std::string& text) {
  try {
    load_with_stream(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("Without keys of products there are none", "[connect]") {
  const ConnectConfig config = load_with_stream("");
  CHECK(config.products->antennas.empty());
  CHECK(config.products->biases.empty());
  CHECK(config.products->leo_elements.empty());
  CHECK(config.products->report.warnings.empty());
}

TEST_CASE("Antenna models and biases are read with the configuration", "[connect]") {
  const ConnectConfig config = load_with_stream(
      "corrections:\n  antenna_models: " + seed("antex/three") +
      "\n  receiver_antenna: TRM59800.00 NONE\n  biases: [" + seed("bias_sinex/both") + "]\n");
  const FileProducts& products = *config.products;
  REQUIRE(products.antennas.size() == 3);
  CHECK(products.antennas[0].is_receiver);
  CHECK(products.antennas[0].offset_m.z() == Approx(0.08));
  CHECK_FALSE(products.antennas[1].is_receiver);
  CHECK(products.biases.size() > 3);
  CHECK(products.report.receiver_antenna == "TRM59800.00     NONE");
  CHECK(products.report.warnings.empty());
  // What is left out is told as by leonav-import.
  CHECK(products.report.skipped.size() == 1);
  CHECK_THAT(products.report.skipped.at(0).reason, Contains("neither OSB nor DSB"));
}

TEST_CASE("What is missing beside antenna models is told with what will be worse", "[connect]") {
  const auto warning = [](const std::string& keys) {
    const auto warnings =
        load_with_stream("corrections: {" + keys + "}\n").products->report.warnings;
    return warnings.size() == 1 ? warnings[0] : std::to_string(warnings.size()) + " warnings";
  };
  const std::string models = "antenna_models: " + seed("antex/three");
  CHECK_THAT(warning(models), Contains("receiver_antenna") && Contains("15 cm"));
  CHECK_THAT(warning(models + ", receiver_antenna: OTHER"), Contains("OTHER"));
  CHECK_THAT(warning(models + ", receiver_antenna: TRM59800.00 SCIS"), Contains("radome"));
}

TEST_CASE("Orbits of mass centres without a satellite's antenna model are told of, where SSR comes",
          "[connect]") {
  const auto warnings = [](const std::string& keys, const std::string& format) {
    const test::TemporaryFile file(
        "connect.yaml", "corrections: {" + keys +
                            "}\nstreams:\n  - {name: a, source: stdin, format: ubx}\n  - "
                            "{name: s, source: tcp, host: h, port: 1, format: " +
                            format + "}\n");
    return load_connect_config(file.path(), {}).products->report.warnings;
  };
  const std::string ssr = "rtcm3, corrections: true", point = "point: mass_centre";
  REQUIRE(warnings(point, ssr).size() == 1);
  CHECK_THAT(warnings(point, ssr)[0], Contains("antenna_models") && Contains("unless another"));
  CHECK(warnings(point, "has").empty());  // whose orbits are of antennas
  CHECK(warnings("point: antenna", ssr).empty());
  const std::string receiver = ", receiver_antenna: TRM59800.00 NONE, antenna_models: ";
  CHECK(warnings(point + receiver + seed("antex/three"), ssr).empty());
  // The receiver's model alone does not help.
  const test::TemporaryFile alone("alone.atx", receivers_alone());
  REQUIRE(warnings(point + receiver + alone.path(), ssr).size() == 1);
  CHECK_THAT(warnings(point + receiver + alone.path(), ssr)[0], Contains("mass_centre"));
}

TEST_CASE("Errors of all files are told at once, with file, line and key", "[connect]") {
  const test::TemporaryFile broken("broken.bia", "no bias file\n");
  const std::string error =
      error_of("corrections:\n  antenna_models: [absent_1.atx, absent_2.atx]\n  biases: [" +
               broken.path() + ", absent.bia]\nleo_elements: absent.csv\nplayback_speed: -1\n");
  for (const char* part :
       {"connect.yaml:2: corrections.antenna_models", "absent_1.atx", "absent_2.atx",
        "connect.yaml:3: corrections.biases", "broken.bia:1", "absent.bia",
        "connect.yaml:4: leo_elements", "absent.csv", "playback_speed"}) {
    CHECK_THAT(error, Contains(part));
  }
}

TEST_CASE("The receiver's antenna needs the file that has its model", "[connect]") {
  CHECK_THAT(error_of("corrections: {receiver_antenna: TRM59800.00 NONE}\n"),
             Contains("corrections.receiver_antenna") && Contains("antenna_models"));
}

TEST_CASE("What comes from files is repeated as the receiver's ephemerides", "[connect]") {
  CHECK(product_repeat_s(load_with_stream("")) == 30.0);
  const test::TemporaryFile file(
      "connect.yaml",
      "streams:\n  - {name: s, source: stdin, format: has}\n"
      "  - {name: a, source: tcp, host: h, port: 1, format: sbf, repeat_ephemerides_s: 12}\n");
  CHECK(product_repeat_s(load_connect_config(file.path(), {})) == 12.0);
}

}  // namespace leonav
