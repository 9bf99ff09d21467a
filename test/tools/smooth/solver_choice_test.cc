// Which solver leonav-smooth takes by itself, and that it says why.
#include "tools/smooth/solver_choice.h"

#include <filesystem>

#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav::test {

using Catch::Contains;

TEST_CASE("Ceres is chosen where it needs at most half of the free memory") {
  const SolverChoice fits = choose_solver(1'000'000, 4.1e9);
  CHECK(fits.name == "ceres");
  CHECK_THAT(fits.reason, Contains("1000000 measurements") && Contains("some 2.0 GB") &&
                              Contains("4.1 GB are free"));
  const SolverChoice tight = choose_solver(1'000'000, 3.9e9);
  CHECK(tight.name == "chain");
  CHECK_THAT(tight.reason, Contains("3.9 GB are free") && Contains("at most half"));
  CHECK(choose_solver(1'000'000, std::nullopt).name == "ceres");
}

TEST_CASE("for a log of more than three million measurements the chain is chosen") {
  CHECK(choose_solver(3'000'000, 1e12).name == "ceres");
  const SolverChoice long_one = choose_solver(3'000'001, 1e12);
  CHECK(long_one.name == "chain");
  CHECK_THAT(long_one.reason, Contains("more than 3000000 measurements"));
}

TEST_CASE("the tightest limit of the groups above a process counts") {
  const TemporaryFile membership("membership", "1:name=systemd:/other\n0::/user/job\n");
  const std::string mount = membership.beside("groups"), user = mount + "/user";
  const std::string job = user + "/job";
  std::filesystem::create_directories(job);
  const auto left = [&] { return left_to_group(mount, membership.path()); };
  CHECK_FALSE(left());

  write_file(job + "/memory.max", "max\n");
  write_file(job + "/memory.current", "100\n");
  CHECK_FALSE(left());
  write_file(user + "/memory.max", "5000\n");
  write_file(user + "/memory.current", "2000\n");
  CHECK(left() == 3000.0);
  write_file(job + "/memory.max", "600\n");
  CHECK(left() == 500.0);
  // A larger limit of which more is taken.
  write_file(user + "/memory.current", "4900\n");
  CHECK(left() == 100.0);
  write_file(user + "/memory.stat", "anon 4600\ninactive_file 300\n");
  CHECK(left() == 400.0);
  write_file(job + "/memory.current", "700\n");
  CHECK(left() == 0.0);
  // A system without groups, or with those of version 1 alone.
  CHECK_FALSE(left_to_group(mount + "/nowhere", mount + "/nothing"));
}

TEST_CASE("the system tells how much memory is free") {
  const auto free = available_memory();
  REQUIRE(free);
  CHECK(*free > 1e6);
  CHECK(*free < 1e15);
}

}  // namespace leonav::test
