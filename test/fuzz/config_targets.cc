// What a user has written, and what an earlier run of leonavd has left.
#include <algorithm>
#include <cmath>
#include <optional>

#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/commands/command_key.h"
#include "daemon/config/load_config.h"
#include "drivers/text/parse.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/checksum_repair.h"
#include "test/fuzz/memory_file.h"
#include "test/fuzz/target_groups.h"
#include "tools/connect/connect_config.h"
#include "tools/serve/serve_config.h"
#include "tools/sim/scenario/scenario_yaml.h"

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

void run_serve_config(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) {
    const ServeConfig config = load_serve_config(path_of_file_with(all), {});
    expect(!config.sentences.empty(), "no sentence to write");
    expect(config.rate_hz >= 0.01 && config.rate_hz <= 200.0, "a rate out of its range");
    expect(config.tcp.port != 0 || config.udp.port != 0 || !config.serial.device.empty() ||
               !config.pty_link.empty(),
           "no output");
  });
}

void run_scenario(FuzzBytes bytes) {
  run_load(bytes, [](FuzzBytes all) {
    const sim::Scenario scenario = sim::load_scenario_text(text_of(all), "fuzz.yaml");
    expect(scenario.start.is_set(), "a scenario without a start");
    expect(scenario.duration_s >= 10.0 && scenario.duration_s <= 86'400.0, "a length out of range");
    for (const sim::ConstellationConfig& constellation : scenario.constellations) {
      for (const sim::OrbitShell& shell : constellation.shells) {
        expect(shell.semi_major_axis_m * (1.0 - shell.eccentricity) >= 6.49e6,
               "an orbit in the Earth");
        expect(std::isfinite(shell.first_anomaly) && std::isfinite(shell.first_node),
               "a satellite without a place");
      }
    }
  });
}

// The key of a file with these bytes; none where it is refused, for a reason.
std::optional<CommandKey> key_of(const std::string& text, std::string* why_not) {
  why_not->clear();
  try {
    return CommandKey::from_file(
        path_of_file_with({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  } catch (const FileError& error) {
    *why_not = error.what();
    return std::nullopt;
  }
}

// What is refused is refused in the same words whatever its characters are, so that no error quotes
// the secret. A key is as long as it must be, and the same with another end of its line.
void run_command_key(FuzzBytes bytes) {
  const std::string text = text_of(bytes);
  std::string masked = text, why_not, why_not_masked;
  std::replace_if(
      masked.begin(), masked.end(), [](char c) { return c > ' ' && c < 127; }, 'x');
  const bool is_key = key_of(masked, &why_not_masked).has_value();
  const std::optional<CommandKey> key = key_of(text, &why_not);
  expect(key.has_value() == is_key && why_not == why_not_masked, "an error that knows the secret");
  if (!key) return;

  SignedCommand command;
  command.mac = key->mac_of(command.nonce, command.command);
  expect(key->has_signed(command), "a key that does not know its own signature");
  const std::string line = text.substr(0, text.find_first_of("\r\n"));
  expect(line.size() >= CommandKey::kFewestCharacters, "a key that is too short");
  if (line.size() > 1000) return;  // the end of a line might be too much
  for (const char* end : {"", "\n", "\r\n"}) {
    const std::optional<CommandKey> same = key_of(line + end, &why_not);
    expect(same && same->has_signed(command), "another key with another end of the line");
  }
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
          {"serve_config", run_serve_config},
          {"scenario", run_scenario},
          {"command_key", run_command_key},
          {"checkpoint", run_checkpoint},
          {"products", run_products}};
}

}  // namespace leonav::test
