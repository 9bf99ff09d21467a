#include "tools/serve/serve_config.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <utility>

#include "daemon/config/config_file.h"
#include "daemon/config/config_groups.h"
#include "daemon/config/load_config.h"

namespace leonav {
namespace {

const std::vector<std::pair<std::string, SentenceKind>> kKinds = {
    {"GGA", SentenceKind::kGga}, {"RMC", SentenceKind::kRmc}, {"VTG", SentenceKind::kVtg},
    {"GST", SentenceKind::kGst}, {"GSA", SentenceKind::kGsa}, {"GSV", SentenceKind::kGsv},
    {"HDT", SentenceKind::kHdt}, {"ZDA", SentenceKind::kZda}};

// Without the key HDT is left out: gpsd 3.22 makes a report of it that many of its clients cannot
// read.
void read_sentences(ConfigReader& root, std::vector<SentenceKind>* sentences) {
  std::vector<std::string> names;
  std::string known;
  for (const auto& [name, kind] : kKinds) known += (known.empty() ? "" : ", ") + name;
  if (!root.list("sentences", &names, "list of " + known)) {
    for (const auto& [name, kind] : kKinds) {
      if (kind != SentenceKind::kHdt) sentences->push_back(kind);
    }
    return;
  }
  for (const std::string& name : names) {
    const auto found = std::find_if(kKinds.begin(), kKinds.end(),
                                    [&name](const auto& one) { return one.first == name; });
    if (found == kKinds.end()) {
      root.report("sentences", "'" + name + "' is none; known are " + known);
    } else {
      sentences->push_back(found->second);
    }
  }
  if (names.empty()) root.report("sentences", "must name at least one of " + known);
}

// Of a ListenOptions or UdpDestination.
template <typename Options>
void read_address(ConfigReader& group, const std::string& remedy, Options* options) {
  int port = options->port;
  group.text("address", &options->address);
  group.integer("port", 0, 65'535, &port);
  options->port = static_cast<std::uint16_t>(port);
  boost::system::error_code error;
  boost::asio::ip::make_address(options->address, error);
  if (error) group.report("address", "'" + options->address + "' is no " + remedy);
}

}  // namespace

ServeConfig load_serve_config(const std::string& path, const std::vector<std::string>& overrides) {
  ServeConfig config;
  ConfigSource source{path.empty() ? "command line" : path};
  const auto read = [&](ConfigReader& root) {
    root.group("lcm", [&](ConfigReader& group) { read_lcm(group, &config.lcm); });
    root.number("rate_hz", {0.01, 200.0}, &config.rate_hz);
    read_sentences(root, &config.sentences);
    root.number("geoid_separation_m", {-200.0, 200.0}, &config.fix.geoid_separation_m);
    root.number("dead_reckoning_limit_m", {0.0, 1e6}, &config.fix.dead_reckoning_limit_m);
    root.number("status_interval_s", {0.0, 3600.0}, &config.status_interval_s);
    root.group("tcp", [&](ConfigReader& group) {
      read_address(group,
                   "address of this host; use 127.0.0.1 for programs on it, 0.0.0.0 for the "
                   "network",
                   &config.tcp);
    });
    root.group("udp", [&](ConfigReader& group) {
      read_address(group,
                   "numeric address; use that of the reader, 127.0.0.1 for one on this host, or "
                   "the network's broadcast address",
                   &config.udp);
    });
    root.group("serial", [&](ConfigReader& group) {
      int baud = 38'400;
      group.text("device", &config.serial.device);
      group.integer("baud", 300, 12'000'000, &baud);
      config.serial.baud = static_cast<unsigned>(baud);
    });
    root.group("pty", [&](ConfigReader& group) { group.text("link", &config.pty_link); });
    if (config.tcp.port == 0 && config.udp.port == 0 && config.serial.device.empty() &&
        config.pty_link.empty()) {
      root.report("tcp", "there is no output; give tcp.port, udp.port, serial.device or pty.link");
    }
  };
  if (path.empty()) {
    read_layers({override_layer(overrides)}, &source, read);
  } else {
    read_yaml(read_config_file(path), overrides, &source, read);
  }
  return config;
}

}  // namespace leonav
