// tools/experiments as its users call it, short: rows run, are not run twice, and end in a report.
#include <filesystem>
#include <fstream>

#include "support/catch.h"
#include "support/program_run.h"
#include "support/temporary_file.h"

using namespace leonav::test;

namespace {

ProgramRun experiments(const std::string& words) {
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("out"), err = place.beside("err");
  const std::string command = "timeout 300 '" LEONAV_SOURCE_DIR "/tools/experiments' " + words +
                              " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = text_of(out);
  run.err = text_of(err);
  return run;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("A short run of the experiments writes its report and is not run twice", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("experiments");
  const std::string words = "--bin '" LEONAV_BIN_DIR
                            "' --quick --seeds 1 --rows 'code-gps-leo' --rows "
                            "'carrier-gps-*ins' --rows convergence-static-gps-leo640 '" +
                            out + "'";
  const ProgramRun first = experiments(words);
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(has(first.err, "4 runs to do, 0 already there"));
  const std::string report = text_of(out + "/report.md");
  CHECK(has(report, "| GPS/LEO/INS | "));
  CHECK(has(report, "1.08 / 1.18 / 0.63 / 1.72"));
  CHECK(has(report, "| GPS/INS → GPS/LEO/INS | "));
  CHECK(has(report, "GPS + LEO 640"));
  CHECK_FALSE(has(report, "failed"));
  for (const char* picture : {"code-cdf.png", "carrier-rmse.png", "carrier-sky.png",
                              "convergence-static-convergence.png"}) {
    CHECK(std::filesystem::file_size(out + "/" + picture) > 1000);
  }
  CHECK_FALSE(std::filesystem::exists(std::filesystem::path(out) / "work" / "city-seed1"));

  const ProgramRun second = experiments(words);
  CHECK(second.exit_code == 0);
  CHECK(has(second.err, "0 runs to do, 4 already there"));
}

TEST_CASE("A row's own commands give its numbers", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string out = place.beside("experiments");
  const ProgramRun run = experiments("--bin '" LEONAV_BIN_DIR
                                     "' --quick --seeds 1 --rows convergence-static-gps-leo160 '" +
                                     out + "'");
  REQUIRE(run.exit_code == 0);
  const std::string report = text_of(out + "/report.md");
  const std::size_t begin = report.find("```sh\n") + 6;
  const std::string commands = report.substr(begin, report.find("```", begin) - begin);
  const std::string elsewhere = place.beside("alone");
  std::filesystem::create_directories(elsewhere);
  const std::string log = place.beside("log");
  // Absolute paths for what lies in the project; written elsewhere.
  const std::string script = "ln -s '" LEONAV_SOURCE_DIR "'/* . 2>/dev/null\nset -e\n" + commands;
  const TemporaryFile file("alone.sh", script);
  const int status = std::system(
      ("cd '" + elsewhere + "' && sh '" + file.path() + "' >'" + log + "' 2>&1").c_str());
  INFO(text_of(log));
  REQUIRE(status == 0);
  const std::string alone = text_of(elsewhere + "/alone/errors.json");
  const std::string rmse = "\"3d_m\": {\"count\": ";
  REQUIRE(has(alone, rmse));
  const std::string result = text_of(out + "/runs/convergence-static-gps-leo160/seed1.json");
  const std::size_t at = alone.find("\"rmse\": ", alone.find(rmse)) + 8;
  CHECK(has(result, alone.substr(at, 6)));
}

TEST_CASE("What fails is told, and tried again; what is stopped goes on", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay", "leonav-eval")) return;
  const TemporaryFile place("unused", "");
  const std::string bin = place.beside("bin"), out = place.beside("experiments");
  const std::string real = LEONAV_BIN_DIR "/";
  std::filesystem::create_directories(bin);
  std::filesystem::create_symlink(real + "leonav-sim", bin + "/leonav-sim");
  const auto wrap = [&](const std::string& name, const std::string& trouble) {
    std::ofstream(bin + "/" + name)
        << "#!/bin/sh\n[ -e '" << place.beside(name + ".trouble") << "' ] && " << trouble
        << "\nexec '" << real << name << "' \"$@\"\n";
    std::filesystem::permissions(bin + "/" + name, std::filesystem::perms::owner_all);
    std::ofstream(place.beside(name + ".trouble")) << "now\n";
  };
  wrap("leonav-eval", "exit 0");          // and nothing written
  wrap("leonav-replay", "kill -INT $$");  // as a terminal's Ctrl-C does
  const std::string words =
      "--bin '" + bin + "' --quick --seeds 1 --rows convergence-static-gps-leo160 '" + out + "'";
  const ProgramRun stopped = experiments(words);
  CHECK(stopped.exit_code == 130);
  CHECK(has(stopped.err, "the same call goes on"));
  CHECK_FALSE(has(stopped.err, "Traceback"));
  std::filesystem::remove(place.beside("leonav-replay.trouble"));

  const ProgramRun failed = experiments(words);
  CHECK(failed.exit_code == 1);
  CHECK(has(failed.err, "1 runs to do"));
  CHECK(has(failed.err, "1 runs failed"));
  CHECK(has(text_of(out + "/report.md"), "errors.json"));
  std::filesystem::remove(place.beside("leonav-eval.trouble"));

  const ProgramRun good = experiments(words);
  INFO(good.err);
  CHECK(good.exit_code == 0);
  CHECK(has(good.err, "1 runs to do"));
}

TEST_CASE("Wrong words to the experiments are named", "[tools]") {
  const ProgramRun row = experiments("--bin '" LEONAV_BIN_DIR "' --rows nonsense x");
  CHECK(row.exit_code == 2);
  CHECK(has(row.err, "--rows nonsense: no row has such a name"));
  const ProgramRun seeds = experiments("--bin '" LEONAV_BIN_DIR "' --seeds 0 x");
  CHECK(seeds.exit_code == 2);
  CHECK(has(seeds.err, "whole number of 1 or more"));
  const TemporaryFile place("unused", "");
  const ProgramRun bin =
      experiments("--bin /nowhere --quick '" + place.beside("experiments") + "'");
  CHECK(bin.exit_code == 1);
  CHECK(has(bin.err, "/nowhere/leonav-sim: No such file or directory; build it"));
  CHECK_FALSE(has(bin.err, "Traceback"));
  CHECK(experiments("--bin '" LEONAV_BIN_DIR "' --list").exit_code == 0);
}
