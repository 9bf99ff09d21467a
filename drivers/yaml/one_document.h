// load_one_document() reads a text of one YAML document, whatever the text is.
#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

namespace leonav {

// Returns the document; null if there is none. Throws YAML::ParserException, with the place, where
// the text is no YAML, has a second document, or is longer than a megabyte. YAML::LoadAll never
// returns where its parser does not get on, as with a comma at the beginning.
YAML::Node load_one_document(const std::string& text);

}  // namespace leonav
