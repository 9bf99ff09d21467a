// This unit reads the keys that name files of products, and the files.
#pragma once
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"
#include "tools/connect/formats/outputs/product_output.h"

namespace leonav {

// Where paths begin, and where an error of a file is noted, so that all of them are told at once.
struct ProductKeys {
  std::string folder;
  std::vector<std::string>* errors;
};

// Reads `antenna_models`, `receiver_antenna` and `biases` of the group of corrections.
void read_correction_files(ConfigReader& group, const ProductKeys& keys, FileProducts* products);
// Reads `leo_elements`.
void read_leo_files(ConfigReader& root, const ProductKeys& keys, FileProducts* products);

}  // namespace leonav
