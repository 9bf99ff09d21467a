#include "tools/common/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <sstream>

#include "drivers/text/nearest_word.h"
#include "drivers/text/parse.h"
#include "tools/common/day.h"

namespace leonav {

Arguments::Arguments(std::string program, std::string synopsis, std::string description)
    : program_(std::move(program)),
      synopsis_(std::move(synopsis)),
      description_(std::move(description)) {}

Arguments& Arguments::option(const std::string& name, const std::string& value_name,
                             const std::string& help, const std::string& fallback) {
  options_.push_back({name, value_name, help, fallback});
  return *this;
}

Arguments& Arguments::flag(const std::string& name, const std::string& help) {
  options_.push_back({name, "", help, ""});
  return *this;
}

const Arguments::Option* Arguments::find(const std::string& name) const {
  for (const Option& option : options_) {
    if (option.name == name) return &option;
  }
  return nullptr;
}

void Arguments::fail_unknown(const std::string& name) const {
  const auto word = [](const std::string& option) {
    return option.substr(std::min(option.find_first_not_of('-'), option.size()));
  };
  std::vector<std::string> words;
  for (const Option& option : options_) words.push_back(word(option.name));
  const auto nearest = nearest_word(word(name), words);
  throw UsageError("unknown option " + name +
                   (nearest ? "; did you mean --" + *nearest + "?" : "") + " (" + program_ +
                   " --help lists them)");
}

bool Arguments::parse(int argc, const char* const* argv) {
  bool options_end = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (options_end || word.size() < 2 || word[0] != '-') {
      positional_.push_back(word);
      continue;
    }
    if (word == "--") {
      options_end = true;
      continue;
    }
    if (word == "--help" || word == "-h") {
      std::cout << help();
      return false;
    }
    if (word == "--version") {
      std::cout << program_ << " " LEONAV_VERSION "\n";
      return false;
    }
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const Option* option = name == "-o" ? find("--out") : find(name);
    if (option == nullptr) fail_unknown(name);
    std::string value;
    if (option->value_name.empty()) {
      if (equals != std::string::npos) throw UsageError(name + " takes no value");
    } else if (equals != std::string::npos) {
      value = word.substr(equals + 1);
    } else {
      if (i + 1 >= argc) throw UsageError(name + " needs a value: " + option->value_name);
      value = argv[++i];
    }
    values_[option->name].push_back(value);
  }
  return true;
}

void Arguments::take_positional_as(const std::string& name) {
  values_[name].push_back(positional_.front());
  positional_.erase(positional_.begin());
}

bool Arguments::has(const std::string& name) const { return values_.count(name) != 0; }

std::string Arguments::get(const std::string& name) const {
  const auto given = values_.find(name);
  if (given != values_.end()) return given->second.back();
  const Option* option = find(name);
  return option != nullptr ? option->fallback : "";
}

std::vector<std::string> Arguments::all(const std::string& name) const {
  const auto given = values_.find(name);
  return given != values_.end() ? given->second : std::vector<std::string>{};
}

double Arguments::number(const std::string& name) const {
  const std::string text = get(name);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || end != text.data() + text.size()) {
    throw UsageError(name + " needs a number, not '" + text + "'");
  }
  return value;
}

GpsTime Arguments::time(const std::string& name) const {
  if (!has(name)) return {};
  const std::string text = get(name);
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto week = parse_int(text.substr(0, colon));
    const auto tow_s = parse_double(text.substr(colon + 1));
    const bool in_range = week && *week >= 0 && *week < 10'000 && tow_s && *tow_s >= 0.0 &&
                          *tow_s <= double{kSecondsPerWeek};
    if (in_range) return GpsTime::from_week_and_tow(*week, *tow_s);
  }
  if (const auto instant = instant_of(text)) return *instant;
  throw UsageError(name +
                   " needs WEEK:SECONDS_OF_WEEK or YYYY-MM-DDThh:mm:ss, both in GPS time, not '" +
                   text + "'");
}

std::string Arguments::required(const std::string& name) const {
  const std::string value = get(name);
  if (value.empty()) throw UsageError(name + " is missing (" + program_ + " --help)");
  return value;
}

std::string Arguments::help() const {
  std::ostringstream text;
  text << "usage: " << program_ << ' ' << synopsis_ << "\n\n" << description_ << "\n\noptions:\n";
  std::size_t width = 9;  // of --version
  for (const Option& option : options_) {
    width = std::max(width, option.name.size() + 1 + option.value_name.size());
  }
  auto line = [&](const std::string& left, const std::string& right) {
    text << "  " << left << std::string(width + 2 - left.size(), ' ') << right << '\n';
  };
  for (const Option& option : options_) {
    line(option.value_name.empty() ? option.name : option.name + ' ' + option.value_name,
         option.help + (option.fallback.empty() ? "" : " [" + option.fallback + "]"));
  }
  line("--help", "print this and exit");
  line("--version", "print the version and exit");
  return text.str();
}

int run_tool(const std::string& program, int (*body)(int, char**), int argc, char** argv) {
  try {
    return body(argc, argv);
  } catch (const UsageError& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace leonav
