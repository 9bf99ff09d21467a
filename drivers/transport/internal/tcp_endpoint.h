// The TcpEndpoint is a connection to a server on the network.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>

#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/internal/name_lookup.h"
#include "drivers/transport/live_sources.h"

namespace leonav {

class TcpEndpoint final : public Endpoint {
 public:
  TcpEndpoint(boost::asio::io_context* io, const TcpOptions& options)
      : options_(options), lookup_(io, options.host, options.port), socket_(*io) {}
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  void close() override;
  bool can_be_half_open() const override { return true; }
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  TcpOptions options_;
  NameLookup lookup_;
  boost::asio::ip::tcp::socket socket_;
  // Counts openings and closings. A callback that holds an older count is of an earlier connection.
  std::uint64_t attempt_ = 0;
};

}  // namespace leonav
