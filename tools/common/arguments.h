// Command lines of the tools: every option declared once, with its help.
#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/time/gps_time.h"

namespace leonav {

// Wrong words on the command line; what() says which and what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Arguments {
 public:
  // `synopsis` and `description` head the text of --help.
  Arguments(std::string program, std::string synopsis, std::string description);

  // An option with a value ("--out DIR"); `fallback` empty: no default.
  Arguments& option(const std::string& name, const std::string& value_name, const std::string& help,
                    const std::string& fallback = "");
  // An option without one.
  Arguments& flag(const std::string& name, const std::string& help);

  // Reads the command line; "--name VALUE" and "--name=VALUE" are alike, "--" ends the options, an
  // option may be repeated. Throws UsageError, for an unknown option with the nearest known one.
  // True: go on; false: --help was asked for and has been printed.
  bool parse(int argc, const char* const* argv);

  bool has(const std::string& name) const;         // given on the command line
  std::string get(const std::string& name) const;  // last one given, or the default
  std::vector<std::string> all(const std::string& name) const;
  double number(const std::string& name) const;  // throws UsageError if it is none
  // Of an option given as WEEK:SECONDS of GPS time; unset where it is not given. Throws UsageError.
  GpsTime time(const std::string& name) const;
  std::string required(const std::string& name) const;  // throws UsageError if absent
  const std::vector<std::string>& positional() const { return positional_; }
  std::string help() const;

 private:
  struct Option {
    std::string name, value_name, help, fallback;
  };
  const Option* find(const std::string& name) const;
  [[noreturn]] void fail_unknown(const std::string& name) const;

  std::string program_, synopsis_, description_;
  std::vector<Option> options_;
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> positional_;
};

// Runs a tool's body: 0 from it is success; UsageError gives 2, any other exception 1, both with a
// message on standard error that starts with the program's name.
int run_tool(const std::string& program, int (*body)(int, char**), int argc, char** argv);

}  // namespace leonav
