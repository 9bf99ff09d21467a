// A file with given content, and one that goes with the object.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace leonav::test {

inline void write_file(const std::string& path, std::string_view content) {
  std::ofstream(path, std::ios::binary) << content;
}

class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, std::string_view content)
      : folder_(make_folder()), path_((folder_ / name).string()) {
    write_file(path_, content);
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }
  std::string beside(const std::string& name) const { return (folder_ / name).string(); }

 private:
  static std::filesystem::path make_folder() {
    std::string text = (std::filesystem::temp_directory_path() / "leonav-test-XXXXXX").string();
    if (::mkdtemp(text.data()) == nullptr) throw std::runtime_error("no temporary folder");
    return text;
  }
  std::filesystem::path folder_;
  std::string path_;
};

}  // namespace leonav::test
