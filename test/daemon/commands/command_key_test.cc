// The key of commands: its file, and what it signs.
#include "daemon/commands/command_key.h"

#include <sys/stat.h>

#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;

const std::string kText = "0123456789abcdef0123456789abcdef";

SignedCommand unsigned_command() {
  SignedCommand command;
  std::uint8_t byte = 10;
  for (std::uint8_t& one : command.nonce) one = byte++;
  byte = 40;
  for (std::uint8_t& one : command.command) one = byte++;
  return command;
}

std::string problem(const std::string& text, mode_t mode = 0600) {
  const test::TemporaryFile file("key", text);
  chmod(file.path().c_str(), mode);
  try {
    static_cast<void>(CommandKey::from_file(file.path()));
    return "none";
  } catch (const FileError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a command is signed as Python's hmac signs it", "[commands]") {
  // hmac.new(key, b"leonav command 1" + bytes(range(10, 26)) + bytes(range(40, 85)), "sha256")
  const CommandMac expected = {0x8c, 0xb3, 0xa7, 0x23, 0x15, 0x8a, 0xd4, 0x2b, 0x90, 0x03, 0xca,
                               0xc3, 0x42, 0xad, 0xa1, 0x8c, 0x61, 0x30, 0x6b, 0x1a, 0xe4, 0xae,
                               0xac, 0x5a, 0x2b, 0x4d, 0xfd, 0xca, 0xfd, 0xb0, 0xb2, 0x2d};
  const SignedCommand command = unsigned_command();
  CHECK(CommandKey(kText).mac_of(command.nonce, command.command) == expected);
}

TEST_CASE("each bit of what is signed, of the signature and of the key matters", "[commands]") {
  const CommandKey key(kText);
  SignedCommand good = unsigned_command();
  good.mac = key.mac_of(good.nonce, good.command);
  CHECK(key.has_signed(good));
  CHECK(!CommandKey("1123456789abcdef0123456789abcdef").has_signed(good));
  const auto refused_without = [&](auto member) {
    for (std::size_t i = 0; i < (good.*member).size(); ++i) {
      SignedCommand changed = good;
      (changed.*member)[i] ^= static_cast<std::uint8_t>(1U << (i % 8));
      CHECK(!key.has_signed(changed));
    }
  };
  refused_without(&SignedCommand::nonce);
  refused_without(&SignedCommand::command);
  refused_without(&SignedCommand::mac);
}

TEST_CASE("the key is the one line of a file that is its owner's alone", "[commands]") {
  const SignedCommand command = unsigned_command();
  const CommandMac mac = CommandKey(kText).mac_of(command.nonce, command.command);
  for (const char* end : {"", "\n", "\r\n"}) {
    const test::TemporaryFile file("key", kText + end);
    chmod(file.path().c_str(), 0400);
    CHECK(CommandKey::from_file(file.path()).mac_of(command.nonce, command.command) == mac);
  }
  CHECK_THAT(problem(kText, 0640), Catch::Contains("chmod 600"));
  for (const std::string& text :
       {kText.substr(1), std::string(), kText + "\n\n", kText + "\nmore", kText + " more",
        kText + std::string(1, '\0'), "\xC3\xA4" + kText}) {
    CHECK_THAT(problem(text), Catch::Contains(":1: must be one line of 32") &&
                                  Catch::Contains("base64") && !Catch::Contains("456789"));
  }
  CHECK_THAT(problem(std::string(2000, 'k')), Catch::Contains("longer than 1024 bytes"));
}
