// The decoding examples of the HAS interface document, annex D.
#pragma once
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/has/reed_solomon.h"
#include "support/recorded/shared_data.h"

namespace leonav::test {

inline constexpr const char* kAnnexD = "wire/has_icd_annex_d.txt";

// One example: pages as sent, the octets decoded from them, and the text of their contents.
struct AnnexExample {
  std::vector<EncodedPage> pages;
  std::vector<std::uint8_t> octets;
  std::string contents;
};

// Reads one of the two examples, 1 or 2, from a file that is there.
inline AnnexExample annex_example(int number) {
  std::ifstream file(shared_data(kAnnexD));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("HAS MESSAGE DECODING EXAMPLE " + std::to_string(number));
  const std::size_t end = text.find("END HAS MESSAGE DECODING EXAMPLE " + std::to_string(number));
  const std::string example = text.substr(begin, end - begin);

  AnnexExample result;
  const std::string sent = example.substr(0, example.find("RS DECODING MATRIX"));
  const std::regex page("// PID\\s+(\\d+)\\s+// HAS encoded page\\s+\\[([^\\]]*)\\]");
  for (std::sregex_iterator match(sent.begin(), sent.end(), page), last; match != last; ++match) {
    EncodedPage& one = result.pages.emplace_back();
    one.id = static_cast<std::uint8_t>(std::stoi((*match)[1]));
    std::istringstream numbers((*match)[2]);
    for (std::uint8_t& octet : one.octets) {
      int value = 0;
      numbers >> value;
      octet = static_cast<std::uint8_t>(value);
    }
  }
  const std::regex hexadecimal("\\[ *([0-9a-f]{100,}) *\\]");
  std::smatch match;
  if (std::regex_search(example, match, hexadecimal)) {
    const std::string digits = match[1];
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
      result.octets.push_back(
          static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    }
  }
  result.contents = example.substr(example.find("HAS DECODED MESSAGE CONTENTS"));
  return result;
}

// Returns the rows of numbers, by satellite, between two headings of the contents.
inline std::vector<std::pair<std::string, std::vector<double>>> annex_rows(
    const std::string& contents, const std::string& from, const std::string& to) {
  const std::size_t begin = contents.find(from);
  const std::string part = contents.substr(begin, contents.find(to, begin) - begin);
  std::vector<std::pair<std::string, std::vector<double>>> rows;
  std::istringstream lines(part);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t remark = line.find("// ");
    const std::string name = remark == std::string::npos ? "" : line.substr(remark + 3, 3);
    std::istringstream numbers(line.substr(0, remark));
    std::vector<double> values;
    for (double value = 0.0; numbers >> value;) values.push_back(value);
    if (!values.empty() && !name.empty()) rows.emplace_back(name, values);
  }
  return rows;
}

}  // namespace leonav::test
