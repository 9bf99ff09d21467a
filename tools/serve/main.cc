// leonav-serve: solutions as NMEA 0183. Exit codes: 0 stopped cleanly; 1 failure while running; 2
// wrong command line; 3 configuration; 4 LCM or network.
#include <spdlog/spdlog.h>

#include "daemon/config/load_config.h"
#include "tools/common/arguments.h"
#include "tools/common/service/service_main.h"
#include "tools/serve/server.h"

namespace {

using namespace leonav;

// The options are keys of the configuration under shorter names.
std::vector<std::string> overrides_of(const Arguments& arguments) {
  std::vector<std::string> overrides;
  const auto set = [&](const char* option, const char* key) {
    if (arguments.has(option)) overrides.push_back(text_override(key, arguments.get(option)));
  };
  const auto set_number = [&](const char* option, const char* key) {
    if (!arguments.has(option)) return;
    arguments.number(option);  // says what is wrong in the option's own name
    overrides.push_back(std::string(key) + "=" + arguments.get(option));
  };
  set_number("--tcp", "tcp.port");
  set("--address", "tcp.address");
  set_number("--udp", "udp.port");
  set("--udp-to", "udp.address");
  set("--serial", "serial.device");
  set_number("--baud", "serial.baud");
  set("--pty", "pty.link");
  set_number("--rate", "rate_hz");
  for (const std::string& one : arguments.all("--set")) overrides.push_back(one);
  return overrides;
}

int serve_main(int argc, char** argv) {
  Arguments arguments(
      "leonav-serve", "[CONFIG.yaml] [options]",
      "Writes the solutions of leonavd as NMEA 0183 sentences (GGA, RMC, VTG, GST, GSA, GSV,\n"
      "ZDA; HDT where it is asked for), for gpsd, chart programs and all that reads a receiver. "
      "Give a file, options, or "
      "both;\n"
      "an option takes precedence over the file.\n"
      "\n"
      "  leonav-serve --tcp 10110                 any number of clients of this host\n"
      "  leonav-serve --tcp 10110 --address 0.0.0.0   and of the network\n"
      "  leonav-serve --udp 10110 --udp-to 192.168.1.255   one host, or all by broadcast\n"
      "  leonav-serve --pty /tmp/leonav-nmea      a pseudo-terminal, as if a receiver were on it\n"
      "  leonav-serve --serial /dev/ttyUSB0 --baud 38400\n"
      "\n"
      "With gpsd: leonav-serve --tcp 10110, then gpsd -N -n tcp://localhost:10110 (or the\n"
      "pseudo-terminal), then cgps. HDT, the heading, is left out, because gpsd 3.22 makes "
      "unreadable\n"
      "JSON of it; a chart program that wants it:\n"
      "--set 'sentences=[GGA, RMC, VTG, GST, GSA, GSV, HDT, ZDA]'.\n"
      "Sentences come once a second of the solution's time. A reader that is too slow loses whole\n"
      "instants and is told by a TXT sentence; it holds nobody else up. Without a position fields\n"
      "are empty; INS alone has quality 6 and mode E. Heights are above the ellipsoid unless\n"
      "geoid_separation_m is set. Every key is explained in config/serve.yaml, and the rest in\n"
      "docs/operations/serve.md. SIGTERM and SIGINT end the program.\n"
      "Exit codes: 0 stopped, 1 failure while running, 2 command line, 3 configuration, 4 LCM.");
  arguments.option("--tcp", "PORT", "serve TCP clients on this port; 10110 is registered for NMEA")
      .option("--address", "ADDRESS", "address to serve on; 127.0.0.1 unless given")
      .option("--udp", "PORT", "send UDP datagrams to this port")
      .option("--udp-to", "ADDRESS", "address to send them to; 127.0.0.1 unless given")
      .option("--serial", "DEVICE", "write to a serial port")
      .option("--baud", "RATE", "of the serial port; 38400 unless given")
      .option("--pty", "LINK", "make a pseudo-terminal and a symbolic link LINK to it")
      .option("--rate", "HZ", "instants per second, 0.01 to 200; 1 unless given")
      .option("--set", "KEY=VALUE", "any key of config/serve.yaml, may be repeated")
      .flag("--check", "only say whether the configuration is good");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() > 1) {
    throw UsageError("give at most one CONFIG.yaml (leonav-serve --help)");
  }
  const std::string path = arguments.positional().empty() ? "" : arguments.positional().front();
  const std::vector<std::string> overrides = overrides_of(arguments);
  if (path.empty() && overrides.empty()) {
    throw UsageError("give a CONFIG.yaml or an output such as --tcp 10110 (leonav-serve --help)");
  }
  const ServeConfig config = load_serve_config(path, overrides);
  if (arguments.has("--check")) {
    spdlog::info("{}: good", path.empty() ? "the command line" : path);
    return 0;
  }
  start_log_thread();  // the one thread of all clients waits for no reader of the log
  return Server(config).run() ? 0 : kExitFailure;
}

}  // namespace

int main(int argc, char** argv) { return service_main("leonav-serve", argc, argv, serve_main); }
