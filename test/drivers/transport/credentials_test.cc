// User and password from a file: what it must look like, and who may read it.
#include "drivers/transport/credentials.h"

#include <sys/stat.h>

#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

std::string problem(const std::string& text, mode_t mode) {
  const test::TemporaryFile file("caster", text);
  chmod(file.path().c_str(), mode);
  try {
    read_credentials(file.path());
    return "none";
  } catch (const FileError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("The first line is the user, the second one the password", "[ntrip]") {
  for (const char* text : {"me\npass: word", "me\npass: word\n", "me\r\npass: word\r\n\r\n"}) {
    const test::TemporaryFile file("caster", text);
    chmod(file.path().c_str(), 0600);
    const Credentials found = read_credentials(file.path());
    CHECK(found.user == "me");
    CHECK(found.password == "pass: word");
  }
  CHECK(problem("me\n", 0400) == "none");  // casters exist that want a name alone
}

TEST_CASE("A file that others may use is refused with the remedy, and nothing is quoted",
          "[ntrip]") {
  for (const mode_t mode : {0640, 0604, 0620, 0601, 0666}) {
    const std::string text = problem("me\nrosebud\n", mode);
    CHECK_THAT(text, Catch::Contains("chmod 600"));
    CHECK_THAT(text, !Catch::Contains("rosebud"));
  }
  for (const std::string& text :
       {std::string("me\nrosebud\nthird\n"), std::string("\nrosebud\n"),
        std::string("m\te\nrosebud\n"), std::string("me\nsec\0ret", 10),
        std::string("m:e\nrosebud"), "me\nrosebud" + std::string(2000, '\n')}) {
    const std::string told = problem(text, 0600);
    CHECK(told != "none");
    CHECK_THAT(told, !Catch::Contains("rosebud"));
  }
  const test::TemporaryFile place("unused", "");
  CHECK_THROWS_WITH(read_credentials(place.beside("none")), Catch::Contains("cannot be opened"));
  REQUIRE(mkfifo(place.beside("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_credentials(place.beside("pipe")), Catch::Contains("no regular file"));
}

}  // namespace leonav
