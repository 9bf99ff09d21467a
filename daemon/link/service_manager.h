// The ServiceManager notifies systemd of start, stop and watchdog by the protocol of sd_notify(3).
#pragma once
#include <sys/socket.h>
#include <sys/un.h>

#include <string>
#include <string_view>

namespace leonav {

// Notifications are datagrams to the socket named in the environment.
class ServiceManager {
 public:
  // Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID. Without them every call below does
  // nothing.
  ServiceManager();
  ~ServiceManager();
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  // The setting of the environment that cannot be followed; empty: none.
  const std::string& problem() const { return problem_; }

  // None of these blocks; a message that finds no room is lost.
  void ready() const { notify("READY=1"); }
  // What follows is a reload, until ready().
  void reloading() const;
  void stopping() const { notify("STOPPING=1"); }
  void feed_watchdog() const {
    if (watchdog_) notify("WATCHDOG=1");
  }

 private:
  void open_socket(const std::string& name);
  void read_watchdog();
  void notify(std::string_view message) const;

  int descriptor_ = -1;
  sockaddr_un address_{};
  socklen_t address_size_ = 0;
  bool watchdog_ = false;
  std::string problem_;
};

}  // namespace leonav
