#include "tools/serve/pty_outlet.h"

#include <fcntl.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "drivers/text/parse.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

void make_link(const std::string& device, const std::string& link) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(link, error)) && !fs::is_symlink(link, error)) {
    throw FileError(link, 0, "is a file of its own and is left alone; choose another pty.link");
  }
  // A link of the last run is to a pseudo-terminal, also where that has gone.
  if (const std::string target = fs::read_symlink(link, error).string();
      !error && !target.starts_with("/dev/pts/")) {
    throw FileError(link, 0,
                    "is a link to " + target + " and is left alone; choose another pty.link");
  }
  fs::remove(link, error);
  fs::create_symlink(device, link, error);
  if (error) {
    throw FileError(link, 0,
                    "cannot be made (" + error.message() +
                        "); check the folder of pty.link and its permissions");
  }
}

// Nothing is echoed, and bytes pass as they are.
void make_raw(int descriptor) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return;
  cfmakeraw(&settings);
  tcsetattr(descriptor, TCSANOW, &settings);
}

}  // namespace

PtyOutlet::PtyOutlet(boost::asio::io_context* io, const std::string& link) : link_(link) {
  const int descriptor = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0 || grantpt(descriptor) != 0 || unlockpt(descriptor) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) close(descriptor);
    throw FileError(link, 0, "no pseudo-terminal can be made (" + why + "); is /dev/pts mounted?");
  }
  terminal_ =
      std::make_shared<Terminal>(boost::asio::posix::stream_descriptor(*io, descriptor), link);
  device_ = ptsname(descriptor);
  terminal_->start([link](const boost::system::error_code& error) {
    spdlog::error("{}: cannot be written any more ({}); start leonav-serve anew", link,
                  error.message());
  });
  // Opened and closed once, the terminal tells by a hang-up that nobody has it open.
  const int reader = open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (reader >= 0) close(reader);
  make_link(device_, link_);
  spdlog::info("{}: a pseudo-terminal, {}", link_, device_);
}

PtyOutlet::~PtyOutlet() {
  std::error_code ignored;
  if (fs::read_symlink(link_, ignored) == device_) fs::remove(link_, ignored);
  terminal_->close();
}

bool PtyOutlet::has_reader() {
  pollfd state{terminal_->stream().native_handle(), POLLOUT, 0};
  return poll(&state, 1, 0) >= 0 && (state.revents & POLLHUP) == 0;
}

void PtyOutlet::send(const std::shared_ptr<const Batch>& batch) {
  const bool is_read = has_reader();
  if (is_read != was_read_) {
    spdlog::info("{}: {}", link_, is_read ? "a reader has opened it" : "the reader has closed it");
    was_read_ = is_read;
    terminal_->forget();
    // The last reader to close it has put its settings back to those of a user's terminal.
    if (is_read) make_raw(terminal_->stream().native_handle());
  }
  if (!is_read) return;
  terminal_->discard_input();
  terminal_->send(batch);
}

std::string PtyOutlet::status() const {
  return link_ + ": " + (was_read_ ? "read" : "nobody reads") + ", " +
         std::to_string(terminal_->lost_sentences()) + " sentences lost";
}

}  // namespace leonav
