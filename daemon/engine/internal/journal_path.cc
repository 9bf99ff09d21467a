#include "daemon/engine/internal/journal_path.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "drivers/lcm/event_log.h"

namespace leonav {
namespace {

// False if something of that name exists; in one step, so that two daemons cannot both succeed.
bool create_new(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno != EEXIST;
  close(descriptor);
  return true;
}

}  // namespace

std::string claim_journal_path(const std::string& path, int most_numbers) {
  std::error_code error;
  if (create_new(path) || !std::filesystem::is_regular_file(path, error)) return path;
  for (int number = 1; number <= most_numbers; ++number) {
    const std::string numbered = path + "." + std::to_string(number);
    if (create_new(numbered)) return numbered;
  }
  throw EventLogError(path + ": exists, and so do .1 to ." + std::to_string(most_numbers) +
                      "; move the journals away");
}

}  // namespace leonav
