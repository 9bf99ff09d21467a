#include "drivers/transport/live_sources.h"

#include "drivers/transport/internal/connection.h"
#include "drivers/transport/internal/input_endpoint.h"
#include "drivers/transport/internal/serial_endpoint.h"
#include "drivers/transport/internal/tcp_endpoint.h"
#include "drivers/transport/internal/tcp_server_endpoint.h"
#include "drivers/transport/internal/udp_endpoint.h"

namespace leonav {

std::unique_ptr<ByteSource> make_serial_source(boost::asio::io_context* io,
                                               const ArrivalClock* clock,
                                               const SerialOptions& options) {
  return std::make_unique<Connection>(io, clock, std::make_unique<SerialEndpoint>(io, options));
}

std::unique_ptr<ByteSource> make_tcp_source(boost::asio::io_context* io, const ArrivalClock* clock,
                                            const TcpOptions& options) {
  return std::make_unique<Connection>(io, clock, std::make_unique<TcpEndpoint>(io, options));
}

std::unique_ptr<ByteSource> make_tcp_server_source(boost::asio::io_context* io,
                                                   const ArrivalClock* clock,
                                                   const ListenOptions& options) {
  return std::make_unique<Connection>(io, clock, std::make_unique<TcpServerEndpoint>(io, options));
}

std::unique_ptr<ByteSource> make_udp_source(boost::asio::io_context* io, const ArrivalClock* clock,
                                            const ListenOptions& options) {
  return std::make_unique<Connection>(io, clock, std::make_unique<UdpEndpoint>(io, options));
}

std::unique_ptr<ByteSource> make_input_source(boost::asio::io_context* io,
                                              const ArrivalClock* clock) {
  return std::make_unique<Connection>(io, clock, std::make_unique<InputEndpoint>(io));
}

}  // namespace leonav
