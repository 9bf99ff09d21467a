#include "drivers/transport/ntrip_source.h"

#include <exception>

#include "drivers/transport/credentials.h"
#include "drivers/transport/internal/connection.h"
#include "drivers/transport/internal/ntrip_endpoint.h"
#include "drivers/transport/internal/tls_context.h"

namespace leonav {

std::string problem_of_credentials(const NtripOptions& options) {
  if (options.credentials_file.empty()) return "";
  try {
    read_credentials(options.credentials_file);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string problem_of_authority(const NtripOptions& options) {
  if (!options.tls) return "";
  try {
    make_tls_context(options.ca_file);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::unique_ptr<ByteSource> make_ntrip_source(boost::asio::io_context* io,
                                              const ArrivalClock* clock,
                                              const NtripOptions& options) {
  return std::make_unique<Connection>(io, clock, std::make_unique<NtripEndpoint>(io, options));
}

}  // namespace leonav
