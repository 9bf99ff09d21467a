// These functions say what failed of a connection that this program makes, with the remedy.
#pragma once
#include <boost/system/error_code.hpp>
#include <string>

namespace leonav {

std::string network_text(const boost::system::error_code& error);

// Of a name that nobody has given an address for in time.
std::string mute_name_server_text();

}  // namespace leonav
