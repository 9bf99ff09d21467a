// SourceOptions say where a stream's bytes come from.
#pragma once
#include <string>
#include <variant>

#include "drivers/transport/live_sources.h"
#include "drivers/transport/ntrip_source.h"

namespace leonav {

struct InputOptions {};  // standard input
struct FileOptions {
  std::string path;
};
struct TcpServerOptions {
  ListenOptions listen;
};
struct UdpOptions {
  ListenOptions listen;
};
using SourceOptions = std::variant<SerialOptions, TcpOptions, NtripOptions, TcpServerOptions,
                                   UdpOptions, InputOptions, FileOptions>;

// Returns what the source is, for logs: "/dev/ttyACM0 at 115200 baud".
std::string text_of(const SourceOptions& source);

// What to look at where the source is open and brings nothing: a question.
std::string silence_remedy(const SourceOptions& source);

}  // namespace leonav
