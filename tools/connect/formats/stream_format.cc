#include "tools/connect/formats/stream_format.h"

#include <limits>

namespace leonav {

double StreamFormat::stamp_sigma_s() const { return std::numeric_limits<double>::quiet_NaN(); }

std::string joined(std::initializer_list<std::string> parts) {
  std::string all;
  for (const std::string& part : parts) {
    if (!part.empty()) all += (all.empty() ? "" : "; ") + part;
  }
  return all;
}

std::vector<FormatNews> warnings_of(std::initializer_list<std::string> texts) {
  std::vector<FormatNews> news;
  for (const std::string& text : texts) {
    if (!text.empty()) news.push_back({true, text});
  }
  return news;
}

}  // namespace leonav
