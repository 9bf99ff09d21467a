// No text keeps the reader of YAML for ever.
#include "drivers/yaml/one_document.h"

#include <string_view>

#include "support/catch.h"

using namespace leonav;

namespace {

std::string error_of(const std::string& text) {
  try {
    load_one_document(text);
    return "";
  } catch (const YAML::Exception& error) {
    return std::to_string(error.mark.line + 1) + ": " + error.msg;
  }
}

}  // namespace

TEST_CASE("a text of one document is read, no document is null, a second one is refused") {
  CHECK(load_one_document("a: {b: 2}")["a"]["b"].as<int>() == 2);
  CHECK(load_one_document("---\na: 1\n")["a"].as<int>() == 1);
  CHECK(load_one_document("").IsNull());
  CHECK(load_one_document("# nothing\n").IsNull());
  CHECK(error_of("a: 1\n---\nb: 2\n").find("2: a second document begins here") == 0);
}

TEST_CASE("a text at which the parser stands still is refused with its line") {
  CHECK(error_of(",").find("1: ") == 0);
  CHECK(error_of("# settings\n, a: 1\n").find("2: a key is expected here") == 0);
  CHECK(error_of("--- ,\n") != "");
  CHECK(error_of(std::string(2'000'000, ' ')).find("longer than a megabyte") != std::string::npos);
}

TEST_CASE("every text of up to four of YAML's special characters comes to an end") {
  constexpr std::string_view kCharacters = ",[]{}:-?&*!|>'\"%# \na";
  std::size_t texts = 0, refused = 0;
  std::string text;
  const auto all = [&](const auto& self, int left) -> void {
    ++texts;
    refused += error_of(text).empty() ? 0 : 1;
    if (left == 0) return;
    for (const char character : kCharacters) {
      text.push_back(character);
      self(self, left - 1);
      text.pop_back();
    }
  };
  all(all, 4);
  CHECK(texts == 1 + 20 + 400 + 8'000 + 160'000);
  CHECK(refused > texts / 10);
}
