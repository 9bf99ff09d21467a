#include "daemon/config/internal/yaml_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace leonav {
namespace {

std::optional<double> parsed(std::string_view digits) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

// A plain word that every YAML reader takes for a text, or a plain number.
bool is_plain(const std::string& text) {
  static constexpr std::array<std::string_view, 14> kOtherMeanings = {
      "y", "Y", "n", "N", "yes", "no", "on", "off", "true", "false", "null", "Yes", "No", "Null"};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_letter = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
  };
  if (text.empty()) return false;
  if (std::all_of(text.begin(), text.end(), is_digit)) return text == "0" || text[0] != '0';
  if (!is_letter(text[0])) return false;
  if (std::count(kOtherMeanings.begin(), kOtherMeanings.end(), text) > 0) return false;
  return std::all_of(text.begin(), text.end(),
                     [&](char c) { return is_letter(c) || is_digit(c) || c == '-'; });
}

}  // namespace

std::string number_text(double number) {
  char digits[64];
  const double size = std::abs(number);
  const bool ordinary = size == 0.0 || (size >= 1e-4 && size < 1e10);
  const auto end =
      ordinary ? std::to_chars(digits, digits + sizeof digits, number, std::chars_format::fixed)
               : std::to_chars(digits, digits + sizeof digits, number);
  return std::string(digits, end.ptr);
}

std::string number_text(double value, double unit) {
  const double quotient = value / unit;
  for (int precision = 1; precision <= 17; ++precision) {
    char digits[64];
    const auto end = std::to_chars(digits, digits + sizeof digits, quotient,
                                   std::chars_format::general, precision);
    const auto number = parsed(std::string_view(digits, end.ptr));
    if (number && *number * unit == value) return number_text(*number);
  }
  // The quotient is rounded, so that one of its neighbours may be meant.
  for (const double towards : {-INFINITY, INFINITY}) {
    const double number = std::nextafter(quotient, towards);
    if (number * unit == value) return number_text(number);
  }
  return number_text(quotient);
}

std::string quoted_text(const std::string& text) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      quoted += {'\\', 'x', kHex[byte >> 4], kHex[byte & 0xf]};
    } else {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string plain_text(const std::string& text) {
  return is_plain(text) ? text : quoted_text(text);
}

std::string list_text(const std::vector<std::string>& elements) {
  std::string text;
  for (const std::string& element : elements) {
    text += (text.empty() ? "" : ", ") + plain_text(element);
  }
  return "[" + text + "]";
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace leonav
