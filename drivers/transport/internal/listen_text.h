// This function says why an address of this machine cannot be listened at, with the remedy.
#pragma once
#include <boost/system/error_code.hpp>
#include <string>

namespace leonav {

std::string listen_text(const boost::system::error_code& error);

}  // namespace leonav
