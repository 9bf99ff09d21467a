// This function says what failed of a connection that this program makes, with the remedy.
#pragma once
#include <boost/system/error_code.hpp>
#include <string>

namespace leonav {

std::string network_text(const boost::system::error_code& error);

}  // namespace leonav
