// Arguments reads the command line of a tool, whose options are declared once, with their help.
#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/gps_time.h"

namespace leonav {

// Error on the command line; what() names the wrong argument and a right one.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Arguments holds the declared options and, after parse(), their values.
class Arguments {
 public:
  // `synopsis` and `description` are the first lines of the text of --help.
  Arguments(std::string program, std::string synopsis, std::string description);

  // Declares an option with a value ("--out DIR"); an empty `fallback` means no default.
  Arguments& option(const std::string& name, const std::string& value_name, const std::string& help,
                    const std::string& fallback = "");
  // Declares an option without a value.
  Arguments& flag(const std::string& name, const std::string& help);

  // Reads the command line.
  //
  // "--name VALUE" and "--name=VALUE" are equivalent, "--" ends the options, and an option may be
  // repeated. Throws UsageError, with the nearest known option for an unknown one. Returns false if
  // --help or --version was given, which has then been printed.
  bool parse(int argc, const char* const* argv);

  // The first positional argument becomes the value of the option `name`.
  void take_positional_as(const std::string& name);

  bool has(const std::string& name) const;         // given on the command line
  std::string get(const std::string& name) const;  // last one given, or the default
  std::vector<std::string> all(const std::string& name) const;
  double number(const std::string& name) const;  // throws UsageError if it is none
  // Returns an option given as WEEK:SECONDS of GPS time; unset if it is not given. Throws
  // UsageError.
  GpsTime time(const std::string& name) const;
  std::string required(const std::string& name) const;  // throws UsageError if absent
  const std::vector<std::string>& positional() const { return positional_; }
  const std::string& program() const { return program_; }
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

// Runs the body of a tool and returns the exit status: 0 on success, 2 for UsageError, 1 for any
// other exception. Both errors print a message on standard error that starts with the program's
// name.
int run_tool(const std::string& program, int (*body)(int, char**), int argc, char** argv);

}  // namespace leonav
