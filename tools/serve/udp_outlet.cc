#include "tools/serve/udp_outlet.h"

#include <spdlog/spdlog.h>

#include <boost/asio/buffer.hpp>
#include <stdexcept>

namespace leonav {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

std::vector<std::string_view> datagrams_of(std::string_view text) {
  constexpr std::size_t kMost = 1'400;  // of the 1,500 bytes of Ethernet
  std::vector<std::string_view> datagrams;
  while (text.size() > kMost) {
    const std::size_t end = text.rfind('\n', kMost - 1);
    if (end == std::string_view::npos) break;  // no sentence is so long
    datagrams.push_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  if (!text.empty()) datagrams.push_back(text);
  return datagrams;
}

UdpOutlet::UdpOutlet(asio::io_context* io, const UdpDestination& destination)
    : destination_(asio::ip::make_address(destination.address), destination.port), socket_(*io) {
  name_ = "UDP to " + destination.address + ", port " + std::to_string(destination.port);
  error_code error;
  socket_.open(destination_.protocol(), error);
  if (!error) socket_.non_blocking(true, error);
  if (!error && destination_.address().is_v4()) {
    socket_.set_option(asio::socket_base::broadcast(true), error);
  }
  if (error) throw std::runtime_error(name_ + " cannot be opened (" + error.message() + ")");
  spdlog::info("{}: open", name_);
}

// An instant with a failure is told as that, also where other datagrams of it went out.
void UdpOutlet::send(const std::shared_ptr<const Batch>& batch) {
  error_code worst;
  for (const std::string_view datagram : datagrams_of(batch->text)) {
    error_code error;
    socket_.send_to(asio::buffer(datagram.data(), datagram.size()), destination_, 0, error);
    ++(error ? lost_ : sent_);
    if (error && (!worst || worst == asio::error::would_block)) worst = error;
  }
  if (worst != asio::error::would_block) tell(worst);
}

// The same failure once.
void UdpOutlet::tell(const error_code& error) {
  if (error == told_) return;
  told_ = error;
  if (!error) {
    spdlog::info("{}: sent again; {} datagrams lost so far", name_, lost_);
  } else {
    spdlog::warn("{}: cannot be sent ({}); is there a route to udp.address (ip route get)?", name_,
                 error.message());
  }
}

std::string UdpOutlet::status() const {
  return name_ + ": " + std::to_string(sent_) + " datagrams sent, " + std::to_string(lost_) +
         " lost";
}

}  // namespace leonav
