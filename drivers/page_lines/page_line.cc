#include "drivers/page_lines/page_line.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::string_view kBlanks = " \t";
using Columns = std::array<std::string_view, 6>;

std::optional<Columns> split(std::string_view line) {
  Columns columns;
  std::size_t count = 0;
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;
       begin = line.find_first_not_of(kBlanks, begin)) {
    if (count == columns.size()) return std::nullopt;
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    columns[count++] = line.substr(begin, end - begin);
    begin = end;
  }
  if (count != columns.size()) return std::nullopt;
  return columns;
}

std::optional<std::uint8_t> digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<std::uint8_t>(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return static_cast<std::uint8_t>(c - 'A' + 10);
  return std::nullopt;
}

// Reads the octets of a page; all digits must be right, those beyond the page too.
bool read_octets(std::string_view hex, CorrectionPage* page) {
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    const auto high = digit(hex[i]), low = digit(hex[i + 1]);
    if (!high || !low) return false;
    if (i / 2 < page->bits.size()) page->bits[i / 2] = static_cast<std::uint8_t>(*high << 4 | *low);
  }
  return true;
}

}  // namespace

std::optional<CorrectionPage> page_from_line(std::string_view line, PageService service) {
  constexpr int kLatestWeek = 9999;
  constexpr std::size_t kLongest = 128;  // octets
  const std::optional<Columns> columns = split(trim(line));
  if (!columns) return std::nullopt;
  const auto& [week_text, second_text, satellite_text, type_text, length_text, hex] = *columns;
  const auto week = parse_int(week_text), satellite = parse_int(satellite_text);
  const auto second = parse_double(second_text);
  const auto length = parse_int(length_text);
  if (!week || *week < 1 || *week > kLatestWeek || !second || *second < 0.0 ||
      *second >= static_cast<double>(kSecondsPerWeek) || !parse_int(type_text)) {
    return std::nullopt;
  }
  CorrectionPage page;
  const bool is_beidou = service == PageService::kBeidouB2b;
  if (!satellite || *satellite < 1 || *satellite > 63 || !length ||
      *length < static_cast<int>(page.bits.size()) || hex.size() % 2 != 0 ||
      hex.size() < 2 * static_cast<std::size_t>(*length) || hex.size() > 2 * kLongest ||
      !read_octets(hex, &page)) {
    return std::nullopt;
  }
  page.service = service;
  page.satellite = {is_beidou ? System::kBeidou : System::kGalileo,
                    static_cast<std::uint16_t>(*satellite)};
  page.received =
      GpsTime::from_week_and_tow(*week, *second - (is_beidou ? kBeidouMinusGpsSeconds : 0));
  return page;
}

bool is_remark(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text.front() == '#';
}

}  // namespace leonav
