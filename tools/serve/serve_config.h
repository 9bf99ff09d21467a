// ServeConfig is the configuration of leonav-serve.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "drivers/nmea/fix_sentences.h"
#include "drivers/transport/live_sources.h"

namespace leonav {

enum class SentenceKind : std::uint8_t { kGga, kRmc, kVtg, kGst, kGsa, kGsv, kHdt, kZda };

struct UdpDestination {
  std::string address = "127.0.0.1";  // of a host, a broadcast or a multicast address
  std::uint16_t port = 0;             // 0: none
};

struct ServeConfig {
  LcmConfig lcm;
  double rate_hz = 1.0;  // of the solution's time
  std::vector<SentenceKind> sentences;
  FixOptions fix;
  ListenOptions tcp;  // port 0: no server
  UdpDestination udp;
  SerialOptions serial;             // an empty device: none
  std::string pty_link;             // symbolic link to a pseudo-terminal; empty: none
  double status_interval_s = 60.0;  // of the text about all outputs; 0: only changes
};

// Reads a configuration file, or none where `path` is empty, with the overrides of a command line
// ("key=value"). Throws ConfigError with file, line, key and remedy.
ServeConfig load_serve_config(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace leonav
