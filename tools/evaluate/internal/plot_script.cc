#include "tools/evaluate/internal/plot_script.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <stdexcept>

namespace leonav {
namespace {

namespace fs = std::filesystem;

// Replaces this process by the script; 127 if that is impossible.
[[noreturn]] void become(const fs::path& script, std::vector<std::string> words) {
  std::string name = script.string();
  std::vector<char*> arguments = {name.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(script.c_str(), arguments.data());
  ::_exit(127);
}

}  // namespace

fs::path make_plot_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!fs::is_directory(path)) throw std::runtime_error(path + ": no folder, and cannot be made");
  return path;
}

void run_plot_script(const std::string& name, const std::vector<std::string>& words,
                     const fs::path& tables) {
  const fs::path script = fs::read_symlink("/proc/self/exe").parent_path() / name;
  std::cout.flush();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process for the plots");
  if (child == 0) become(script, words);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw std::runtime_error(script.string() + " cannot be run; the tables are in " +
                             tables.string());
  throw std::runtime_error("the plots failed; the tables are in " + tables.string());
}

}  // namespace leonav
