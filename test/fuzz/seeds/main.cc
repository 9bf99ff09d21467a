// leonav-fuzz-seeds CORPUS: writes the seeds that leonav's own encoders make.
#include <cstdio>
#include <string_view>

#include "test/fuzz/seeds/seed_writer.h"

namespace {

constexpr const char* kUsage =
    "usage: leonav-fuzz-seeds CORPUS\n"
    "Writes the seeds that leonav's own encoders make into the folder CORPUS, in a folder for "
    "each\n"
    "target. test/fuzz/make_corpus calls it, and makes the other seeds.\n";

}  // namespace

int main(int count, char** arguments) {
  const std::string_view corpus = count == 2 ? arguments[1] : "";
  if (corpus == "--help") {
    std::fputs(kUsage, stdout);
    return 0;
  }
  // A word with a dash is meant as an option, and would become a folder that is hard to remove.
  if (corpus.empty() || corpus.starts_with('-')) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  leonav::test::SeedWriter writer(arguments[1]);
  leonav::test::write_message_seeds(&writer);
  leonav::test::write_log_seeds(&writer);
  leonav::test::write_state_seeds(&writer);
  leonav::test::write_page_seeds(&writer);
  leonav::test::write_script_seeds(&writer);
}
