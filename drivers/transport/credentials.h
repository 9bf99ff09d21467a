// This unit reads a user's name and password from a file that nobody else may read.
#pragma once
#include <string>

namespace leonav {

struct Credentials {
  std::string user, password;
};

// The first line of the file is the user's name, the second one the password; both may be anything
// but control characters, and the name has no colon (RFC 7617, chapter 2). Throws FileError where
// the file cannot be opened, is no regular file, may be read or written by its group or by others,
// or has other lines. No error quotes what is in the file.
Credentials read_credentials(const std::string& path);

}  // namespace leonav
