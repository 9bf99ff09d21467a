#include "tools/connect/source_options.h"

namespace leonav {
namespace {

std::string place(const std::string& host, std::uint16_t port) {
  return host + ":" + std::to_string(port);
}

struct SourceText {
  std::string operator()(const SerialOptions& serial) const {
    return serial.device + " at " + std::to_string(serial.baud) + " baud";
  }
  std::string operator()(const TcpOptions& tcp) const { return place(tcp.host, tcp.port); }
  std::string operator()(const NtripOptions& ntrip) const {
    return "NTRIP " + place(ntrip.host, ntrip.port) + "/" + ntrip.mountpoint +
           (ntrip.tls ? " over TLS" : "");
  }
  std::string operator()(const TcpServerOptions& server) const {
    return "a client at " + place(server.listen.address, server.listen.port);
  }
  std::string operator()(const UdpOptions& udp) const {
    return "UDP at " + place(udp.listen.address, udp.listen.port);
  }
  std::string operator()(const InputOptions&) const { return "standard input"; }
  std::string operator()(const FileOptions& file) const { return file.path; }
};

struct Remedy {
  std::string operator()(const NtripOptions& ntrip) const {
    return ntrip.position_line ? "does the caster serve this position, and does the network run?"
                               : "does the base send, or does the caster want a 'position' first?";
  }
  std::string operator()(const TcpOptions&) const {
    return "is the sensor behind the server on, and told to send?";
  }
  std::string operator()(const TcpServerOptions&) const {
    return "does the client still run, and is its sensor told to send?";
  }
  std::string operator()(const UdpOptions&) const {
    return "does the sender run, does it send to this address and port, and does the firewall let "
           "it through?";
  }
  template <typename Other>
  std::string operator()(const Other&) const {
    return "is the sensor on, wired to this port, and told to send?";
  }
};

}  // namespace

std::string text_of(const SourceOptions& source) { return std::visit(SourceText(), source); }
std::string silence_remedy(const SourceOptions& source) { return std::visit(Remedy(), source); }

}  // namespace leonav
