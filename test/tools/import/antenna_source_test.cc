#include "tools/import/internal/antenna_source.h"

#include <fstream>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;

namespace {

std::string labelled(std::string text, const std::string& label) {
  text.resize(60, ' ');
  return text + label + "\n";
}

const std::string kHeader = labelled("     1.4            M", "ANTEX VERSION / SYST") +
                            labelled("A", "PCV TYPE / REFANT") + labelled("", "END OF HEADER");

std::string antenna(const std::string& name, const std::string& up) {
  return labelled("", "START OF ANTENNA") + labelled(name, "TYPE / SERIAL NO") +
         labelled("     0.0", "DAZI") + labelled("     0.0   1.0   1.0", "ZEN1 / ZEN2 / DZEN") +
         labelled("   G01", "START OF FREQUENCY") +
         labelled("      0.00      0.00" + up, "NORTH / EAST / UP") + "   NOAZI    0.00    0.00\n" +
         labelled("   G01", "END OF FREQUENCY") + labelled("", "END OF ANTENNA");
}

const std::string kG05 = "BLOCK IIF           G05                 G063      2011-036A";
const GpsTime kTime = from_calendar({2020, 1, 1});

struct Loaded {
  std::vector<AntennaPattern> patterns;
  ImportReport report;
};

Loaded load(const std::vector<std::string>& texts, const std::string& header,
            const std::string& override_name = "") {
  const TemporaryFile place("unused", "");
  Dataset dataset;
  dataset.orbits = {"x.sp3"};
  dataset.receiver_antenna = override_name;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    dataset.antenna_models.push_back(place.beside(std::to_string(i) + ".atx"));
    std::ofstream(dataset.antenna_models.back()) << kHeader << texts[i];
  }
  Loaded loaded;
  loaded.patterns = load_antennas(dataset, header, kTime, &loaded.report);
  return loaded;
}

std::string warnings(const Loaded& loaded) {
  std::string all;
  for (const std::string& warning : loaded.report.warnings) all += warning + "\n";
  return all;
}

}  // namespace

TEST_CASE("the header names the receiver antenna, the dataset goes before it", "[import]") {
  const std::string text = antenna(kG05, "   1000.00") +
                           antenna("TRM59800.00     NONE", "     50.00") +
                           antenna("LEIAR25.R4      LEIT", "    150.00");
  Loaded loaded = load({text}, "TRM59800.00     NONE");
  REQUIRE(loaded.patterns.size() == 2);
  CHECK(loaded.patterns[0].is_receiver);
  CHECK(loaded.patterns[0].offset_m.z() == Approx(0.05));
  CHECK(loaded.report.satellite_antennas == 1);
  CHECK(loaded.report.warnings.empty());
  loaded = load({text}, "TRM59800.00     NONE", "LEIAR25.R4 LEIT");
  CHECK(loaded.patterns[0].offset_m.z() == Approx(0.15));
}

TEST_CASE("of several antenna files the first that has an antenna counts", "[import]") {
  const Loaded loaded =
      load({antenna("TRM59800.00     NONE", "     50.00"),
            antenna(kG05, "   1000.00") + antenna("TRM59800.00     SCIS", "     60.00"),
            antenna(kG05, "   2000.00")},
           "TRM59800.00     SCIS");
  REQUIRE(loaded.patterns.size() == 2);
  CHECK(loaded.patterns[0].offset_m.z() == Approx(0.06));
  CHECK(loaded.patterns[1].offset_m.z() == Approx(1.0));
  CHECK(loaded.report.warnings.empty());
}

TEST_CASE("a missing antenna model is reported with what will be worse", "[import]") {
  const std::string satellite = antenna(kG05, "   1000.00");
  CHECK_THAT(warnings(load({}, "TRM59800.00")), Catch::Contains("no antenna_models"));
  CHECK_THAT(warnings(load({satellite}, "")), Catch::Contains("ANT # / TYPE"));
  CHECK_THAT(warnings(load({satellite}, "TRM59800.00")),
             Catch::Contains("no antenna model of the receiver antenna 'TRM59800.00     NONE'"));
  CHECK_THAT(warnings(load({satellite + antenna("TRM59800.00     NONE", "      1.00")},
                           "TRM59800.00     SCIS")),
             Catch::Contains("off by some millimetres"));
  CHECK_THAT(warnings(load({antenna("TRM59800.00     NONE", "      1.00")}, "TRM59800.00")),
             Catch::Contains("of any satellite"));
  CHECK_THROWS_AS(load({antenna("TRM59800.00     NONE", "      1.00")}, "OTHER"), FileError);
}
