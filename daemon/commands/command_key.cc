#include "daemon/commands/command_key.h"

#include <nettle/hmac.h>
#include <nettle/memops.h>

#include <algorithm>

#include "drivers/text/parse.h"
#include "drivers/text/secret_file.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxBytes = 1024;
// What is signed begins with it, so that the key signs nothing else alike.
constexpr std::string_view kPurpose = "leonav command 1";

bool is_visible(char c) { return c > ' ' && c < '\x7F'; }

}  // namespace

CommandKey CommandKey::from_file(const std::string& path) {
  const std::string bytes = read_secret_file(path, kMaxBytes);
  std::string_view line = bytes;
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.size() < kFewestCharacters || !std::all_of(line.begin(), line.end(), is_visible)) {
    throw FileError(path, 1,
                    "must be one line of " + std::to_string(kFewestCharacters) +
                        " ASCII characters or more without blanks; make one: head -c 32 "
                        "/dev/urandom | base64");
  }
  return CommandKey(line);
}

CommandMac CommandKey::mac_of(const CommandNonce& nonce, const CommandBytes& command) const {
  hmac_sha256_ctx context;
  hmac_sha256_set_key(&context, key_.size(), reinterpret_cast<const std::uint8_t*>(key_.data()));
  hmac_sha256_update(&context, kPurpose.size(),
                     reinterpret_cast<const std::uint8_t*>(kPurpose.data()));
  hmac_sha256_update(&context, nonce.size(), nonce.data());
  hmac_sha256_update(&context, command.size(), command.data());
  CommandMac mac;
  hmac_sha256_digest(&context, mac.size(), mac.data());
  return mac;
}

bool CommandKey::has_signed(const SignedCommand& command) const {
  const CommandMac mac = mac_of(command.nonce, command.command);
  return memeql_sec(mac.data(), command.mac.data(), mac.size()) != 0;
}

}  // namespace leonav
