// The keys of street errors: the file that shows them all, and what is refused.
#include "tools/sim/scenario/street_errors_config.h"

#include "daemon/config/config_file.h"
#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;

namespace {

// Returns the group as config/scenario/open_sky.yaml has it.
std::string shown_group() {
  const std::string text = read_config_file(LEONAV_SOURCE_DIR "/config/scenario/open_sky.yaml");
  const std::size_t begin = text.find("\nstreet_errors:") + 1;
  return text.substr(begin, text.find("\n\n", begin) - begin);
}

sim::Scenario with(const std::string& keys) {
  return sim::load_scenario_text("street_errors: {" + keys + "}\n", "test.yaml");
}

}  // namespace

TEST_CASE("open_sky.yaml shows every key of street errors, with its default", "[sim][street]") {
  ConfigSource source{"open_sky.yaml"};
  sim::StreetErrorsConfig street;
  read_yaml(shown_group(), {}, &source, [&](ConfigReader& root) {
    root.group("street_errors", [&](ConfigReader& r) { sim::read_street_errors(r, "", &street); });
  });
  CHECK(source.keys.size() > 20);
  for (const ConfigKey& key : source.keys) {
    INFO(key.path << ": " << key.value << ", default " << key.built_in);
    CHECK(key.given);
    CHECK(key.is_default());
  }
}

TEST_CASE("Street errors that make no sense are refused", "[sim][street]") {
  CHECK_THROWS_WITH(with("family: ray"), Catch::Contains("correlated"));
  CHECK_THROWS_WITH(with("multipath: {code_low_m: [5, 1]}"), Catch::Contains("least"));
  CHECK_THROWS_WITH(with("multipath: {code_low_m: [1, 2, 3]}"), Catch::Contains("two numbers"));
  CHECK_THROWS_WITH(with("multipath: {code_low_m: 3}"), Catch::Contains("list"));
  CHECK_THROWS_WITH(with("blocked: {share: 1}"), Catch::Contains("0.95"));
  CHECK_THROWS_WITH(with("slips: {single_share: 0.6, pair_share: 0.6}"),
                    Catch::Contains("more than 1"));
  CHECK_THROWS_WITH(with("family: recorded"), Catch::Contains("street-residuals"));
  CHECK_THROWS_WITH(with("family: recorded, file: none.csv"),
                    Catch::Contains("none.csv is not there; tools/validate"));
}

TEST_CASE("Another family replaces the receiver's own multipath and slips", "[sim][street]") {
  const sim::Scenario rays = with("family: rays"), other = with("family: correlated");
  CHECK(rays.receiver.multipath.code_m > 0.0);
  CHECK(rays.receiver.tracking.slips_per_hour > 0.0);
  CHECK(other.receiver.multipath.code_m == 0.0);
  CHECK(other.receiver.multipath.carrier_m == 0.0);
  CHECK(other.receiver.tracking.slips_per_hour == 0.0);
}
