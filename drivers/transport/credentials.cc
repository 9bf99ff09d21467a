#include "drivers/transport/credentials.h"

#include <algorithm>
#include <string_view>

#include "drivers/text/parse.h"
#include "drivers/text/secret_file.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxBytes = 1024;

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
  const std::string all = read_secret_file(path, kMaxBytes);
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
