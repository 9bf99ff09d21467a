// leonav-report as its users call it: pictures from good files, a named line from bad ones.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/catch.h"

namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / "leonav_report_test";
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
  // Exit code; the messages go to `messages`.
  int report(const std::string& words, std::string* messages) const {
    const std::string log = (path / "messages.txt").string();
    const int status = std::system(("'" LEONAV_BIN_DIR "/leonav-report' " + words + " --out '" +
                                    (path / "plots").string() + "' >'" + log + "' 2>&1")
                                       .c_str());
    std::ifstream stream(log);
    messages->assign(std::istreambuf_iterator<char>(stream), {});
    return WEXITSTATUS(status);
  }
};

std::string rows(const std::string& extra) {
  std::string text = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m" + extra + "\n";
  for (int i = 0; i < 20; ++i) {
    text += "2200," + std::to_string(1000 + i) + ",45.000" + std::to_string(10 + i) + ",7.0,100.0";
    text += extra.empty() ? "\n" : ",0.5,0.5,1.0,8,1.9\n";
  }
  return text;
}

}  // namespace

TEST_CASE("report draws track, errors, distribution and satellites") {
  const Folder folder;
  const std::string truth = folder.file("truth.csv", rows(""));
  const std::string solution =
      folder.file("solution.csv", rows(",std_north_m,std_east_m,std_down_m,satellites,pdop"));
  std::string messages;
  const int status = folder.report("--truth '" + truth + "' 'run=" + solution + "'", &messages);
  INFO(messages);
  REQUIRE(status == 0);
  for (const char* name : {"track.png", "errors.png", "cdf.png", "satellites.png", "index.html"}) {
    CHECK(fs::file_size(folder.path / "plots" / name) > 100);
  }
}

TEST_CASE("report says which package is missing") {
  const Folder folder;
  folder.file("numpy.py", "raise ImportError('No module named numpy')\n");
  std::string messages;
  ::setenv("PYTHONPATH", folder.path.c_str(), 1);
  CHECK(folder.report("run.csv", &messages) == 1);
  ::unsetenv("PYTHONPATH");
  CHECK(messages.find("leonav-report: No module named numpy; install python3-numpy") == 0);
}

TEST_CASE("report names the file and line it cannot read, and fails") {
  const Folder folder;
  std::string messages;
  CHECK(folder.report("'" + folder.file("bad.csv", rows("") + "2200,x,45,7,100\n") + "'",
                      &messages) == 1);
  CHECK(messages.find("bad.csv:22: 'x' is no number") != std::string::npos);
  CHECK(folder.report("absent.pos", &messages) == 1);
  CHECK(messages.find("absent.pos: No such file") != std::string::npos);
  CHECK(folder.report(
            "'" +
                folder.file("empty.csv",
                            "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n1,2,,,\n") +
                "'",
            &messages) == 1);
  CHECK(messages.find("no row has a position") != std::string::npos);
  CHECK(messages.find("Traceback") == std::string::npos);
}
