#include "drivers/transport/internal/udp_endpoint.h"

#include <boost/asio/post.hpp>
#include <utility>

#include "drivers/transport/internal/listen_text.h"

namespace leonav {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

void UdpEndpoint::open(Opened opened) {
  error_code error;
  const udp::endpoint place(asio::ip::make_address(options_.address, error), options_.port);
  if (!error) socket_.open(place.protocol(), error);
  if (!error) socket_.bind(place, error);
  if (error) close();
  asio::post(socket_.get_executor(), [opened = std::move(opened), error] { opened(error); });
}

void UdpEndpoint::read(asio::mutable_buffer buffer, Read done) {
  socket_.async_receive(buffer, std::move(done));
}

void UdpEndpoint::close() {
  error_code ignored;
  socket_.close(ignored);
}

std::string UdpEndpoint::text_of(const error_code& error) const {
  return options_.address + ":" + std::to_string(options_.port) + ": " + listen_text(error);
}

}  // namespace leonav
