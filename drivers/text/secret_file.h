// This unit reads a secret from a file that nobody but its owner may read.
#pragma once
#include <cstddef>
#include <string>

namespace leonav {

// Returns the file's bytes. Throws FileError where it cannot be opened, is no regular file, may be
// read or written by its group or by others, or has more than `max_bytes`. No error quotes what is
// in the file.
std::string read_secret_file(const std::string& path, std::size_t max_bytes);

}  // namespace leonav
