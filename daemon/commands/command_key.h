// The CommandKey signs commands and tells whether one is signed: HMAC-SHA256 (RFC 2104).
#pragma once
#include <string>
#include <string_view>

#include "drivers/lcm/signed_command.h"

namespace leonav {

class CommandKey {
 public:
  // Of fewer characters a key could be guessed.
  static constexpr std::size_t kFewestCharacters = 32;

  // Reads the key from a file that only its owner may read: one line of 32 characters or more,
  // without blanks, whose bytes are the key. Throws FileError, which never quotes the file.
  static CommandKey from_file(const std::string& path);
  explicit CommandKey(std::string_view key) : key_(key) {}

  // Neither allocates.
  CommandMac mac_of(const CommandNonce& nonce, const CommandBytes& command) const;
  // The time it takes does not tell how much of a wrong mac is right.
  bool has_signed(const SignedCommand& command) const;

 private:
  std::string key_;
};

}  // namespace leonav
