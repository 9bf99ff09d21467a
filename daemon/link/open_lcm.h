// These functions open LCM, and say what is in the way where it cannot work.
#pragma once
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace leonav {

class LcmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The reason why multicast messages to `url` would be lost, with the command that mends it;
// nullopt: no reason known. Call it before liblcm, which waits for seconds and then reports little.
std::optional<std::string> multicast_problem(const std::string& url);

// Opens LCM at `url`, after multicast_problem(). Throws LcmError with cause and remedy.
std::unique_ptr<lcm::LCM> open_lcm(const std::string& url);

}  // namespace leonav
