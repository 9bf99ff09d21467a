// The UdpEndpoint takes datagrams, from whoever sends them.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <string>

#include "drivers/transport/internal/endpoint.h"
#include "drivers/transport/live_sources.h"

namespace leonav {

class UdpEndpoint final : public Endpoint {
 public:
  UdpEndpoint(boost::asio::io_context* io, const ListenOptions& options)
      : options_(options), socket_(*io) {}
  void open(Opened opened) override;
  void read(boost::asio::mutable_buffer buffer, Read done) override;
  void close() override;
  std::string text_of(const boost::system::error_code& error) const override;

 private:
  ListenOptions options_;
  boost::asio::ip::udp::socket socket_;
};

}  // namespace leonav
