#include "drivers/transport/credentials.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxBytes = 1024;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

// The mode is that of the open file, so that no other file can take its place after the check.
void refuse_open_to_others(const std::string& path, int file) {
  struct stat status = {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw FileError(path, 0, "is no regular file; name a file with the user's name and password");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw FileError(
        path, 0,
        "holds a password and is open to others than its owner; close it: chmod 600 " + path);
  }
}

std::string contents(const std::string& path, int file) {
  std::array<char, kMaxBytes + 1> buffer;
  std::size_t count = 0;
  while (count < buffer.size()) {
    const ssize_t got = read(file, buffer.data() + count, buffer.size() - count);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw FileError(path, 0, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    count += static_cast<std::size_t>(got);
  }
  if (count > kMaxBytes) throw FileError(path, 0, "is longer than a name and a password can be");
  return {buffer.data(), count};
}

// Takes the first line from `text`, without its end.
std::string take_line(std::string_view* text) {
  const std::size_t end = text->find('\n');
  std::string_view line = text->substr(0, end);
  text->remove_prefix(end == std::string_view::npos ? text->size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return std::string(line);
}

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7F;
  });
}

}  // namespace

Credentials read_credentials(const std::string& path) {
  // Without O_NONBLOCK a named pipe would hold the program up before it can be refused.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path, and that the file belongs to this user");
  }
  refuse_open_to_others(path, file.number());
  const std::string all = contents(path, file.number());
  std::string_view rest = all;
  Credentials found;
  found.user = take_line(&rest);
  found.password = take_line(&rest);
  if (found.user.empty() || has_control(found.user) || has_control(found.password) ||
      rest.find_first_not_of("\r\n") != std::string_view::npos) {
    throw FileError(path, 0,
                    "must have the user's name in its first line, the password in the second, if "
                    "there is one, and nothing else");
  }
  if (found.user.find(':') != std::string::npos) {
    throw FileError(path, 1, "the user's name must have no colon");
  }
  return found;
}

}  // namespace leonav
