#include "drivers/transport/internal/listen_text.h"

#include <boost/asio/error.hpp>

namespace leonav {

std::string listen_text(const boost::system::error_code& error) {
  namespace errc = boost::system::errc;
  if (error == boost::asio::error::address_in_use) {
    return "another program has this port; ss -lntup names it";
  }
  if (error == errc::address_not_available) {
    return "this machine has no such address (yet); ip address lists those that it has";
  }
  if (error == errc::permission_denied) {
    return "may not be listened at; use a port above 1023";
  }
  return error.message();
}

}  // namespace leonav
