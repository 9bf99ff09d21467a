// What a user has written, and what an earlier run of leonavd has left.
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/config/load_config.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/checksum_repair.h"
#include "test/fuzz/memory_file.h"
#include "test/fuzz/target_groups.h"
#include "tools/connect/connect_config.h"

namespace leonav::test {
namespace {

template <typename Load>
void run_load(FuzzBytes bytes, Load load) {
  try {
    load(bytes);
  } catch (const ConfigError& error) {
    if (std::string_view(error.what()).empty()) throw Finding("an error without a word");
  }
}

std::string text_of(FuzzBytes bytes) { return {bytes.begin(), bytes.end()}; }

void run_config(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) { load_config_text(text_of(all), "fuzz.yaml"); });
}

// Lines are overrides of the command line.
void run_overrides(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) {
    const std::string text = text_of(all);
    std::vector<std::string> overrides;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      overrides.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    load_config_text("vehicle: {}\n", "fuzz.yaml", overrides);
  });
}

void run_connect_config(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) { load_connect_config(path_of_file_with(all), {}); });
}

void run_checkpoint(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) {
    if (!load_checkpoint(path_of_file_with(all))) throw Finding("a file that is there is not");
  });
}

// The first byte tells whether a wrong sum stays.
void run_products(FuzzBytes bytes) {
  ByteScript script(bytes);
  const bool repairs = (script.byte() & 0x80U) == 0;
  const FuzzBytes rest = script.rest();
  std::vector<std::uint8_t> content(rest.begin(), rest.end());
  if (repairs) repair_products(&content);
  run_load(content, [](FuzzBytes all) {
    const auto products = load_products(path_of_file_with(all));
    if (!products) throw Finding("a file that is there is not");
    ProductsText texts;
    const std::string text = texts.of(*products);
    const auto again = load_products(
        path_of_file_with({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    if (!again || texts.of(*again) != text) throw Finding("products change when saved");
  });
}

}  // namespace

std::vector<FuzzTarget> config_targets() {
  return {{"config", run_config},
          {"overrides", run_overrides},
          {"connect_config", run_connect_config},
          {"checkpoint", run_checkpoint},
          {"products", run_products}};
}

}  // namespace leonav::test
