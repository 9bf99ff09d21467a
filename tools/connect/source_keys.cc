#include "tools/connect/source_keys.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/base/angle.h"
#include "tools/connect/in_folder.h"
#include "tools/connect/position_line.h"

namespace leonav {
namespace {

enum class SourceKind : std::uint8_t { kSerial, kTcp, kNtrip, kTcpServer, kUdp, kInput, kFile };

std::uint16_t read_port(ConfigReader& group, int port) {
  group.integer("port", 0, 65'535, &port);
  if (port == 0) group.report("port", "must be given, from 1 to 65535");
  return static_cast<std::uint16_t>(port);
}

// Names go into requests and messages, where blanks and control characters have a meaning.
bool is_one_word(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7F'; });
}

// Returns whether the text can be a name or an address alone. Whoever knows other programs may
// write user, password, port and mountpoint before and behind it.
bool is_host(const std::string& text) {
  if (!is_one_word(text) || text.find_first_of("@/") != std::string::npos) return false;
  boost::system::error_code no_address;
  boost::asio::ip::make_address_v6(text, no_address);
  return !no_address || text.find(':') == std::string::npos;
}

// The message must not quote what was written: a password may be in it.
std::string read_host(ConfigReader& group, const std::string& remedy) {
  std::string host;
  group.text("host", &host);
  if (!is_host(host)) {
    group.report("host",
                 "must be a name or an address alone, such as caster.example or 192.168.1.10; "
                 "the port has its own key, 'port'" +
                     remedy);
  }
  return host;
}

SerialOptions read_serial(ConfigReader& group) {
  SerialOptions options;
  int baud = 115'200;
  group.text("device", &options.device);
  group.integer("baud", 300, 12'000'000, &baud);
  if (options.device.empty()) group.report("device", "must name a port, such as /dev/ttyACM0");
  options.baud = static_cast<unsigned>(baud);
  return options;
}

TcpOptions read_tcp(ConfigReader& group) {
  TcpOptions options;
  options.host = read_host(group, "");
  options.port = read_port(group, 0);
  return options;
}

ListenOptions read_listen(ConfigReader& group) {
  ListenOptions options;
  group.text("address", &options.address);
  boost::system::error_code wrong;
  boost::asio::ip::make_address(options.address, wrong);
  if (wrong) {
    group.report("address",
                 "must be an address of this machine: 127.0.0.1 for programs on it, "
                 "0.0.0.0 for all of its networks");
  }
  options.port = read_port(group, 0);
  return options;
}

void read_position(ConfigReader& group, NtripOptions* options) {
  std::vector<double> values;
  group.numbers("position", {-10'000.0, 10'000.0}, &values);
  if (values.empty()) return;
  if (values.size() != 3 || std::abs(values[0]) > 90.0 || std::abs(values[1]) > 180.0) {
    group.report("position",
                 "must be [latitude, longitude, height]: degrees from -90 to 90, degrees "
                 "from -180 to 180, metres above the ellipsoid");
  } else {
    const ReportedPosition position{values[0] * kDegree, values[1] * kDegree, values[2]};
    options->position_line = [position] { return position_line_now(position); };
  }
  group.number("position_interval_s", {0.0, 3600.0}, &options->position_interval_s);
  if (options->position_interval_s > 0.0 && options->position_interval_s < 1.0)
    group.report("position_interval_s", "must be at least 1 s, or 0 for once");
}

NtripOptions read_ntrip(ConfigReader& group, const std::string& folder) {
  NtripOptions options;
  options.host = read_host(group,
                           ", and so has the 'mountpoint'; user and password belong into the file "
                           "that 'credentials_file' names");
  options.port = read_port(group, options.port);
  group.text("mountpoint", &options.mountpoint);
  if (!is_one_word(options.mountpoint) || options.mountpoint.find('/') != std::string::npos) {
    group.report("mountpoint", "must name a stream of the caster's source table, without a slash");
  }
  group.choice<NtripVersion>(
      "version", {{"auto", NtripVersion::kAuto}, {"1", NtripVersion::k1}, {"2", NtripVersion::k2}},
      &options.version);
  group.boolean("tls", &options.tls);
  if (options.tls) group.text("ca_file", &options.ca_file);
  options.ca_file = in_folder(folder, options.ca_file);
  group.text("credentials_file", &options.credentials_file);
  options.credentials_file = in_folder(folder, options.credentials_file);
  read_position(group, &options);
  if (const std::string problem = problem_of_credentials(options); !problem.empty()) {
    group.report("credentials_file", problem);
  }
  if (const std::string problem = problem_of_authority(options); !problem.empty()) {
    group.report("ca_file", problem);
  }
  return options;
}

FileOptions read_file(ConfigReader& group, const std::string& folder) {
  FileOptions options;
  group.text("path", &options.path);
  if (options.path.empty()) group.report("path", "must name a recording or a file of bytes");
  options.path = in_folder(folder, options.path);
  return options;
}

SourceKind read_kind(ConfigReader& group) {
  SourceKind kind = SourceKind::kSerial;
  group.choice<SourceKind>("source",
                           {{"serial", SourceKind::kSerial},
                            {"tcp", SourceKind::kTcp},
                            {"ntrip", SourceKind::kNtrip},
                            {"tcp_server", SourceKind::kTcpServer},
                            {"udp", SourceKind::kUdp},
                            {"stdin", SourceKind::kInput},
                            {"file", SourceKind::kFile}},
                           &kind);
  return kind;
}

}  // namespace

void read_source(ConfigReader& group, const std::string& folder, SourceOptions* source) {
  switch (read_kind(group)) {
    case SourceKind::kSerial:
      *source = read_serial(group);
      break;
    case SourceKind::kTcp:
      *source = read_tcp(group);
      break;
    case SourceKind::kNtrip:
      *source = read_ntrip(group, folder);
      break;
    case SourceKind::kTcpServer:
      *source = TcpServerOptions{read_listen(group)};
      break;
    case SourceKind::kUdp:
      *source = UdpOptions{read_listen(group)};
      break;
    case SourceKind::kInput:
      *source = InputOptions();
      break;
    case SourceKind::kFile:
      *source = read_file(group, folder);
      break;
  }
}

}  // namespace leonav
