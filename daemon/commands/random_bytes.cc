#include "daemon/commands/random_bytes.h"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

namespace leonav {

void fill_random(std::span<std::uint8_t> bytes) {
  const ssize_t got = getrandom(bytes.data(), bytes.size(), 0);
  if (got != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(got < 0 ? errno : EIO, std::generic_category(),
                            "no random numbers (getrandom)");
}

}  // namespace leonav
