// A secret comes from a file of this user alone.
#include "drivers/text/secret_file.h"

#include <sys/stat.h>

#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {

TEST_CASE("The bytes of a secret are those of the file, up to the limit", "[secret_file]") {
  const test::TemporaryFile file("secret", "open\nsesame");
  chmod(file.path().c_str(), 0600);
  CHECK(read_secret_file(file.path(), 100) == "open\nsesame");
  CHECK(read_secret_file(file.path(), 11) == "open\nsesame");
  CHECK_THROWS_WITH(read_secret_file(file.path(), 10),
                    Catch::Contains("longer than 10 bytes") && !Catch::Contains("sesame"));
}

TEST_CASE("A secret that others may use is refused with the remedy", "[secret_file]") {
  const test::TemporaryFile file("secret", "sesame");
  for (const mode_t mode : {0640, 0604, 0620, 0601, 0666}) {
    chmod(file.path().c_str(), mode);
    CHECK_THROWS_WITH(read_secret_file(file.path(), 100),
                      Catch::Contains("chmod 600") && !Catch::Contains("sesame"));
  }
  CHECK_THROWS_WITH(read_secret_file(file.beside("none"), 100),
                    Catch::Contains("cannot be opened"));
  REQUIRE(mkfifo(file.beside("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_AS(read_secret_file(file.beside("pipe"), 100), FileError);
}

}  // namespace leonav
