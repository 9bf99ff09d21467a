// These functions make the sources that are connected to something: a serial port, a server or a
// client on the network, standard input.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "drivers/transport/arrival_clock.h"
#include "drivers/transport/byte_source.h"

namespace boost::asio {
class io_context;
}

namespace leonav {

// A serial port or pseudo-terminal with 8 data bits, no parity, one stop bit, no flow control.
struct SerialOptions {
  std::string device;  // e.g. /dev/ttyACM0
  unsigned baud = 0;   // bits per second; pseudo-terminals and USB ignore it
};

struct TcpOptions {
  std::string host;  // name or address
  std::uint16_t port = 0;
};

// An address of this machine, and a port, at which clients or datagrams are awaited.
struct ListenOptions {
  std::string address = "127.0.0.1";  // 0.0.0.0, ::: every one
  std::uint16_t port = 0;
};

// The source opens its port or connection when it is started, and again after each failure, with
// waits that grow (retry_wait.h). `io` and `clock` must outlive it.
std::unique_ptr<ByteSource> make_serial_source(boost::asio::io_context* io,
                                               const ArrivalClock* clock,
                                               const SerialOptions& options);
std::unique_ptr<ByteSource> make_tcp_source(boost::asio::io_context* io, const ArrivalClock* clock,
                                            const TcpOptions& options);
// Clients that connect are read one after the other, in the order in which they came.
std::unique_ptr<ByteSource> make_tcp_server_source(boost::asio::io_context* io,
                                                   const ArrivalClock* clock,
                                                   const ListenOptions& options);
// The bytes of all datagrams, whoever sends them, one after the other.
std::unique_ptr<ByteSource> make_udp_source(boost::asio::io_context* io, const ArrivalClock* clock,
                                            const ListenOptions& options);
// Standard input ends where its writer closes it; it is never opened again.
std::unique_ptr<ByteSource> make_input_source(boost::asio::io_context* io,
                                              const ArrivalClock* clock);

}  // namespace leonav
