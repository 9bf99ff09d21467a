#include "drivers/transport/internal/network_text.h"

#include <boost/asio/error.hpp>

namespace leonav {

std::string mute_name_server_text() {
  return "the name server does not answer; check the network and /etc/resolv.conf, or give the "
         "address as 'host'";
}

std::string network_text(const boost::system::error_code& error) {
  namespace errors = boost::asio::error;
  if (error == errors::host_not_found) {
    return "the name is not known; check 'host' and the name server";
  }
  if (error == errors::host_not_found_try_again) return mute_name_server_text();
  if (error == errors::connection_refused) {
    return "nothing listens there; is the server running, and is 'port' right?";
  }
  if (error == errors::timed_out)
    return "does not answer; check the cable, 'host' and the firewall";
  if (error == errors::eof) return "the server closed the connection";
  return error.message();
}

}  // namespace leonav
