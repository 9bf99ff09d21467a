// leonav-connect: receivers and inertial sensors into LCM. Exit codes: 0 stopped cleanly, or every
// stream ended; 1 failure while running; 2 wrong command line; 3 configuration; 4 LCM or network.
#include <spdlog/spdlog.h>

#include "tools/common/arguments.h"
#include "tools/common/service/service_main.h"
#include "tools/connect/connector.h"

namespace {

using namespace leonav;

// What the files of products leave out.
void tell(const ImportReport& report) {
  for (const ImportReport::Skip& skip : report.skipped) {
    spdlog::info("left out: {} x {} ({})", skip.count, skip.reason, skip.where);
  }
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
}

int connect_main(int argc, char** argv) {
  Arguments arguments(
      "leonav-connect", "CONFIG.yaml [options]",
      "Reads receivers and inertial sensors and publishes what they measure on LCM, for leonavd.\n"
      "CONFIG.yaml lists the streams. Each has a name, a source and a format:\n"
      "\n"
      "  streams:\n"
      "    - name: receiver\n"
      "      source: serial            # serial, tcp, tcp_server, udp, ntrip, stdin or file\n"
      "      device: /dev/ttyACM0      # serial: device, baud; tcp: host, port; file: path;\n"
      "                                # tcp_server, udp: address, port; ntrip: host, port,\n"
      "                                # mountpoint, tls, credentials_file, position and others\n"
      "      baud: 460800\n"
      "      format: ubx               # ubx, oem7, sbf, rtcm3, vectornav, xsens,\n"
      "                                # imu_line, has or b2b\n"
      "      record: receiver.leoraw   # optional: every byte, for a file source later\n"
      "    - {name: imu, source: serial, device: /dev/ttyUSB0, baud: 921600, format: vectornav}\n"
      "\n"
      "Every key is explained in config/connect.yaml and docs/operations/connect.md. The state of\n"
      "each stream is logged when it changes, and published once a second on STREAMS.\n"
      "SIGTERM and SIGINT end the program; it ends by itself when every stream has ended.\n"
      "Exit codes: 0 stopped or ended, 1 failure while running or nothing published, 2 command\n"
      "line, 3 configuration, 4 LCM.");
  arguments.option("--set", "KEY=VALUE", "a key outside of 'streams', may be repeated")
      .flag("--check", "only say whether the configuration is good");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) {
    throw UsageError("give one CONFIG.yaml (leonav-connect --help)");
  }
  const std::string path = arguments.positional().front();
  const ConnectConfig config = load_connect_config(path, arguments.all("--set"));
  tell(config.products->report);
  if (arguments.has("--check")) {
    spdlog::info("{}: good, {} streams", path, config.streams.size());
    return 0;
  }
  start_log_thread();  // the one thread of all streams waits for no reader of the log
  return Connector(config).run() == ConnectorEnd::kFailed ? kExitFailure : 0;
}

}  // namespace

int main(int argc, char** argv) { return service_main("leonav-connect", argc, argv, connect_main); }
