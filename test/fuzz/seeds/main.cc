// leonav-fuzz-seeds CORPUS: writes the seeds that leonav's own encoders make.
#include <cstdio>

#include "test/fuzz/seeds/seed_writer.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: leonav-fuzz-seeds CORPUS\n");
    return 2;
  }
  leonav::test::SeedWriter writer(arguments[1]);
  leonav::test::write_message_seeds(&writer);
  leonav::test::write_log_seeds(&writer);
  leonav::test::write_state_seeds(&writer);
  leonav::test::write_page_seeds(&writer);
  leonav::test::write_script_seeds(&writer);
}
