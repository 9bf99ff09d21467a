#include "daemon/log/descriptor_write.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>

namespace leonav {

bool wait_for_room(int descriptor, int longest_ms) {
  pollfd place{descriptor, POLLOUT, 0};
  int ready = 0;
  do ready = poll(&place, 1, longest_ms);
  while (ready < 0 && errno == EINTR);
  return ready > 0 && (place.revents & POLLOUT) != 0;
}

std::string_view write_whole(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(descriptor, text.data(), text.size());
    if (written > 0)
      text.remove_prefix(static_cast<std::size_t>(written));
    else if (written < 0 && errno == EAGAIN)
      wait_for_room(descriptor, -1);
    else if (written == 0 || errno != EINTR)
      break;
  }
  return text;
}

// A pipe that has any room takes PIPE_BUF bytes at once.
std::string_view write_where_there_is_room(int descriptor, std::string_view text, int longest_ms) {
  while (!text.empty()) {
    if (!wait_for_room(descriptor, longest_ms)) break;
    const ssize_t written =
        write(descriptor, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (written > 0)
      text.remove_prefix(static_cast<std::size_t>(written));
    else if (written == 0 || (errno != EINTR && errno != EAGAIN))
      break;
  }
  return text;
}

}  // namespace leonav
