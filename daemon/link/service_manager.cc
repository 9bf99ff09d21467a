#include "daemon/link/service_manager.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <optional>

namespace leonav {
namespace {

// `main` feeds once a second, and a second's grace is the least for a busy machine.
constexpr std::uint64_t kShortestWatchdog_us = 2'000'000;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::optional<std::uint64_t> whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

ServiceManager::ServiceManager() {
  const std::string name = environment("NOTIFY_SOCKET");
  if (name.empty()) return;
  open_socket(name);
  if (descriptor_ >= 0) read_watchdog();
}

ServiceManager::~ServiceManager() {
  if (descriptor_ >= 0) close(descriptor_);
}

// "/path", or "@name" for a name outside of the file system, which begins with a zero and is as
// long as the address says.
void ServiceManager::open_socket(const std::string& name) {
  const bool abstract = name[0] == '@';
  if ((!abstract && name[0] != '/') || name.size() < 2) {
    problem_ = "NOTIFY_SOCKET '" + name + "': neither a path nor @name";
    return;
  }
  if (name.size() >= sizeof address_.sun_path) {
    problem_ = "NOTIFY_SOCKET '" + name + "': too long";
    return;
  }
  address_.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address_.sun_path);
  if (abstract) address_.sun_path[0] = '\0';
  address_size_ =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (abstract ? 0 : 1));
  descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor_ < 0) problem_ = std::string("NOTIFY_SOCKET: ") + std::strerror(errno);
}

void ServiceManager::read_watchdog() {
  const std::string interval = environment("WATCHDOG_USEC"), process = environment("WATCHDOG_PID");
  if (interval.empty()) return;
  // Meant for another process, whose environment was inherited.
  if (!process.empty() && whole_number(process) != static_cast<std::uint64_t>(getpid())) return;
  const auto interval_us = whole_number(interval);
  watchdog_ = interval_us.has_value() && *interval_us > 0;
  if (!watchdog_) {
    problem_ = "WATCHDOG_USEC '" + interval + "': not a number of microseconds";
  } else if (*interval_us < kShortestWatchdog_us) {
    problem_ = "WATCHDOG_USEC " + interval + ": fed once a second only; use WatchdogSec=2 or more";
  }
}

void ServiceManager::reloading() const {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // of the same clock as the service manager's
  const std::int64_t now_us = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
  notify("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(now_us));
}

void ServiceManager::notify(std::string_view message) const {
  if (descriptor_ < 0) return;
  sendto(descriptor_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address_), address_size_);
}

}  // namespace leonav
