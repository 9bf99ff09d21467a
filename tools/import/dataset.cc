#include "tools/import/dataset.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "drivers/text/line_reader.h"
#include "drivers/text/nearest_word.h"
#include "drivers/text/parse.h"
#include "drivers/yaml/one_document.h"
#include "tools/common/day.h"

namespace leonav {
namespace {

long line_of(const YAML::Mark& mark) { return mark.is_null() ? 0 : mark.line + 1; }

constexpr const char* kDateKey = "date";
constexpr const char* kScaleKey = "imu_scale";
constexpr const char* kLatencyKey = "corrections_latency_s";
constexpr const char* kPointKey = "corrections_point";

class DatasetParser {
 public:
  explicit DatasetParser(const std::string& path) { dataset_.path = path; }

  Dataset parse(const YAML::Node& root) {
    if (!root.IsMap()) fail(root, "is no list of 'key: value' lines; see the keys in --help");
    for (const auto& entry : root) take(entry.first, entry.second);
    return dataset_;
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& message) const {
    throw FileError(dataset_.path, line_of(node.Mark()), message);
  }

  void take(const YAML::Node& key_node, const YAML::Node& value) {
    if (!key_node.IsScalar()) fail(key_node, "a key must be a word");
    const std::string& key = key_node.Scalar();
    if (!seen_.insert(key).second) fail(key_node, "key '" + key + "' is given twice; keep one");
    if (key == kDateKey) {
      dataset_.date = read_date(value);
      return;
    }
    if (key == kScaleKey) {
      dataset_.imu_scale = read_scale(value);
      return;
    }
    if (key == kLatencyKey) {
      dataset_.corrections_latency_s = read_latency(value);
      return;
    }
    if (key == kPointKey) {
      dataset_.corrections_at_antenna = read_is_antenna(value);
      return;
    }
    for (const auto& [name, text] : texts_) {
      if (key == name) {
        if (!value.IsScalar() && !value.IsNull()) fail(value, "'" + key + "' must be text");
        *text = value.IsNull() ? "" : value.Scalar();
        return;
      }
    }
    for (const auto& [name, paths] : lists_) {
      if (key == name) {
        *paths = read_paths(key, value);
        return;
      }
    }
    fail_unknown(key_node, key);
  }

  std::vector<std::string> read_paths(const std::string& key, const YAML::Node& value) const {
    std::vector<std::string> paths;
    if (value.IsNull()) return paths;
    if (value.IsScalar()) {
      add(value.Scalar(), &paths);
    } else if (value.IsSequence()) {
      for (const YAML::Node& item : value) {
        if (!item.IsScalar()) fail(item, "'" + key + "' must be a path or a list of paths");
        add(item.Scalar(), &paths);
      }
    } else {
      fail(value, "'" + key + "' must be a path or a list of paths");
    }
    return paths;
  }

  GpsTime read_date(const YAML::Node& value) const {
    if (value.IsNull() || (value.IsScalar() && value.Scalar().empty())) return {};
    const std::optional<GpsTime> date = value.IsScalar() ? noon_of(value.Scalar()) : std::nullopt;
    if (!date) fail(value, "'date' must be the day of the recording, written as 2024-03-20");
    return *date;
  }

  ImuScale read_scale(const YAML::Node& value) const {
    std::vector<double> numbers;
    for (const YAML::Node& item : value) {
      const auto number = item.IsScalar() ? parse_double(item.Scalar()) : std::nullopt;
      if (number && *number > 0.0 && *number <= 1.0) numbers.push_back(*number);
    }
    if (numbers.size() != 2 || value.size() != 2) {
      fail(value, "'imu_scale' must be two numbers, what a count stands for: [rad, m/s]");
    }
    return {numbers[0], numbers[1]};
  }

  double read_latency(const YAML::Node& value) const {
    constexpr double kLongest_s = 600.0;
    double seconds = -1.0;
    const bool is_number = value.IsScalar() && YAML::convert<double>::decode(value, seconds);
    if (!is_number || !(seconds >= 0.0 && seconds <= kLongest_s)) {
      fail(value, "'corrections_latency_s' must be a number of seconds from 0 to 600");
    }
    return seconds;
  }

  bool read_is_antenna(const YAML::Node& value) const {
    const std::string word = value.IsScalar() ? value.Scalar() : "";
    if (word != "antenna" && word != "mass_centre") {
      fail(value,
           "'corrections_point' must be 'antenna' or 'mass_centre': which point of a satellite "
           "the corrected orbits are of");
    }
    return word == "antenna";
  }

  void add(const std::string& text, std::vector<std::string>* paths) const {
    if (text.empty()) return;
    const auto folder = std::filesystem::path(dataset_.path).parent_path();
    paths->push_back((folder / text).string());
  }

  [[noreturn]] void fail_unknown(const YAML::Node& node, const std::string& key) const {
    std::vector<std::string> known = {kDateKey, kScaleKey, kLatencyKey, kPointKey};
    for (const auto& [name, text] : texts_) known.push_back(name);
    for (const auto& [name, paths] : lists_) known.push_back(name);
    std::string message = "unknown key '" + key + "'";
    if (const auto nearest = nearest_word(key, known)) {
      message += "; did you mean '" + *nearest + "'?";
    } else {
      message += "; known are";
      for (std::size_t i = 0; i < known.size(); ++i) message += (i == 0 ? " " : ", ") + known[i];
    }
    fail(node, message);
  }

  Dataset dataset_;
  std::set<std::string> seen_;
  const std::vector<std::pair<std::string, std::string*>> texts_ = {
      {"name", &dataset_.name}, {"receiver_antenna", &dataset_.receiver_antenna}};
  const std::vector<std::pair<std::string, std::vector<std::string>*>> lists_ = {
      {"observations", &dataset_.observations},
      {"navigation", &dataset_.navigation},
      {"leo_elements", &dataset_.leo_elements},
      {"orbits", &dataset_.orbits},
      {"clocks", &dataset_.clocks},
      {"biases", &dataset_.biases},
      {"corrections", &dataset_.corrections},
      {"antenna_models", &dataset_.antenna_models},
      {"imu", &dataset_.imu},
      {"truth", &dataset_.truth}};
};

}  // namespace

std::vector<std::string> Dataset::files() const {
  std::vector<std::string> all = {path};
  for (const auto* paths : {&observations, &navigation, &leo_elements, &orbits, &clocks, &biases,
                            &corrections, &antenna_models, &imu, &truth}) {
    all.insert(all.end(), paths->begin(), paths->end());
  }
  return all;
}

Dataset load_dataset(const std::string& path) {
  // Reports what is wrong with the path, and refuses files that are not text, before YAML reads
  // them.
  LineReader lines(path);
  std::string text;
  for (std::string_view line; lines.next(line);) text.append(line).push_back('\n');
  try {
    return DatasetParser(path).parse(load_one_document(text));
  } catch (const YAML::Exception& error) {
    throw FileError(path, line_of(error.mark), "is not readable as YAML: " + error.msg);
  }
}

}  // namespace leonav
