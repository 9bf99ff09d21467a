// The UdpOutlet sends datagrams to one destination: a host, a broadcast or a multicast address.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <string_view>
#include <vector>

#include "tools/serve/outlet.h"
#include "tools/serve/serve_config.h"

namespace leonav {

// Returns the pieces of `text` that go into one datagram each: whole sentences, as many as fit into
// a packet that no network cuts.
std::vector<std::string_view> datagrams_of(std::string_view text);

// Nobody answers, so a destination without a reader is not known of. What the network does not take
// is lost and counted, and told unless the network was only busy.
class UdpOutlet final : public Outlet {
 public:
  // Throws std::runtime_error where no socket can be had.
  UdpOutlet(boost::asio::io_context* io, const UdpDestination& destination);

  void send(const std::shared_ptr<const Batch>& batch) override;
  std::string status() const override;

 private:
  void tell(const boost::system::error_code& error);

  boost::asio::ip::udp::endpoint destination_;
  boost::asio::ip::udp::socket socket_;
  std::string name_;
  boost::system::error_code told_;
  std::uint64_t sent_ = 0, lost_ = 0;  // datagrams
};

}  // namespace leonav
