// config/dataset.yaml, the example with every key.
#include <sstream>
#include <string>
#include <vector>

#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"
#include "tools/import/dataset.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kExample = LEONAV_SOURCE_DIR "/config/dataset.yaml";

// What the refusal of an unknown key lists.
std::vector<std::string> known_keys() {
  const TemporaryFile file("dataset.yaml", "qqqqqqqqqqqq: x\n");
  std::string text;
  try {
    load_dataset(file.path());
  } catch (const std::exception& error) {
    text = error.what();
  }
  const std::string begin = "known are ";
  REQUIRE(text.find(begin) != std::string::npos);
  std::istringstream list(text.substr(text.find(begin) + begin.size()));
  std::vector<std::string> keys;
  for (std::string key; list >> key;) {
    if (!key.empty() && key.back() == ',') key.pop_back();
    keys.push_back(key);
  }
  return keys;
}

}  // namespace

TEST_CASE("the example of a dataset is read, and has every key", "[import]") {
  const Dataset dataset = load_dataset(kExample);
  CHECK(dataset.observations.size() == 2);
  CHECK(dataset.orbits.size() == 2);
  CHECK(dataset.imu_scale.has_value());
  CHECK(dataset.date.is_set());
  CHECK_FALSE(dataset.receiver_antenna.empty());
  const std::string text = text_of(kExample);
  const auto keys = known_keys();
  CHECK(keys.size() > 12);
  for (const std::string& key : keys) {
    INFO(key);
    CHECK(text.find("\n" + key + ": ") != std::string::npos);
  }
}
