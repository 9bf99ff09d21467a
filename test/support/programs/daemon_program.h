// leonavd as a service manager would run it: started, watched, told to stop.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/programs/program_run.h"
#include "support/temporary_file.h"

namespace leonav::test {

class DaemonProgram {
 public:
  // `environment`: "NAME=value", added to that of the test. Its LCM stays inside the process. The
  // configuration is the preset phone_imu, unless --config is among the arguments.
  explicit DaemonProgram(std::vector<std::string> arguments,
                         std::vector<std::string> environment = {}) {
    std::vector<std::string> words = {LEONAV_BIN_DIR "/leonavd", "--lcm-url", "memq://", "--set",
                                      "realtime.lock_memory=false"};
    if (std::find(arguments.begin(), arguments.end(), "--config") == arguments.end())
      words.insert(words.end(), {"--preset", "phone_imu"});
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (char** one = environ; *one != nullptr; ++one) environment.emplace_back(*one);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 2, text_.path().c_str(), O_WRONLY | O_TRUNC, 0600);
    std::vector<char*> argv = pointers(&words), envp = pointers(&environment);
    failed_ = posix_spawn(&process_, argv[0], &actions, nullptr, argv.data(), envp.data()) != 0;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~DaemonProgram() {
    if (running()) signal(SIGKILL);
    if (!failed_ && !ended_) waitpid(process_, nullptr, 0);
  }
  DaemonProgram(const DaemonProgram&) = delete;
  DaemonProgram& operator=(const DaemonProgram&) = delete;

  pid_t process() const { return process_; }
  std::string text() const { return text_of(text_.path()); }
  void signal(int number) const { kill(process_, number); }

  bool running() {
    if (failed_ || ended_) return false;
    ended_ = waitpid(process_, &status_, WNOHANG) == process_;
    return !ended_;
  }

  bool says_by_now(const std::string& words) const {
    return text().find(words) != std::string::npos;
  }
  // Waits, a minute at most, until what it has said on standard error holds `words`.
  bool says(const std::string& words) {
    for (int i = 0; i < 6000; ++i) {
      const bool was_running = running();
      if (says_by_now(words)) return true;
      if (!was_running) return false;
      usleep(10'000);
    }
    return false;
  }

  // SIGTERM, and wait().
  int stop() {
    if (running()) signal(SIGTERM);
    return wait();
  }
  // Waits for its end: the exit code, or 128 and the signal that ended it; -1: still running after
  // a minute.
  int wait() {
    for (int i = 0; i < 6000 && running(); ++i) usleep(10'000);
    if (!ended_) return -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  }

 private:
  static std::vector<char*> pointers(std::vector<std::string>* words) {
    std::vector<char*> list;
    for (std::string& word : *words) list.push_back(word.data());
    list.push_back(nullptr);
    return list;
  }

  TemporaryFile text_{"text", ""};
  pid_t process_ = -1;
  int status_ = 0;
  bool failed_ = false, ended_ = false;
};

}  // namespace leonav::test
