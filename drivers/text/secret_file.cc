#include "drivers/text/secret_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/text/parse.h"

namespace leonav {
namespace {

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
    throw FileError(path, 0, "is no regular file; name the file that holds the secret");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw FileError(
        path, 0,
        "holds a secret and is open to others than its owner; close it: chmod 600 " + path);
  }
}

}  // namespace

std::string read_secret_file(const std::string& path, std::size_t max_bytes) {
  // Without O_NONBLOCK a named pipe would hold the program up before it can be refused.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    throw FileError(path, 0,
                    std::string("cannot be opened (") + std::strerror(errno) +
                        "); check the path, and that the file belongs to this user");
  }
  refuse_open_to_others(path, file.number());
  std::string bytes(max_bytes + 1, '\0');
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t got = read(file.number(), bytes.data() + count, bytes.size() - count);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw FileError(path, 0, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) break;
    count += static_cast<std::size_t>(got);
  }
  if (count > max_bytes) {
    throw FileError(path, 0,
                    "is longer than " + std::to_string(max_bytes) +
                        " bytes; name the file that holds the secret");
  }
  bytes.resize(count);
  return bytes;
}

}  // namespace leonav
