// KeptNames passes the names of kept pieces from the journal's thread to the one that logs them.
#pragma once
#include <array>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdio>
#include <optional>
#include <string>

namespace leonav {

// Names that find no room are not told; the pieces are counted elsewhere. Putting allocates
// nothing.
class KeptNames {
 public:
  void put(const char* name) {
    Name copy{};
    std::snprintf(copy.data(), copy.size(), "%s", name);
    names_.push(copy);
  }
  // nullopt: there is none.
  std::optional<std::string> take() {
    Name name;
    if (!names_.pop(name)) return std::nullopt;
    return std::string(name.data());
  }

 private:
  using Name = std::array<char, 256>;
  boost::lockfree::spsc_queue<Name, boost::lockfree::capacity<32>> names_;
};

}  // namespace leonav
