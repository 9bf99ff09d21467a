// This unit makes text from outside, such as a file's name, fit for XML and JSON.
#pragma once
#include <string>
#include <string_view>

namespace leonav {

// Returns `text` with question marks for bytes that are no UTF-8, and for characters that XML 1.0
// does not allow.
std::string valid_text(std::string_view text);

// Returns valid text for the content of an element or an attribute of XML: markup is escaped.
std::string xml_text(std::string_view text);

}  // namespace leonav
