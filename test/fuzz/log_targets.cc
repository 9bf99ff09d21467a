// Event logs: one file, and the pieces of a journal in a folder.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "drivers/lcm/event_log.h"
#include "drivers/lcm/journal_pieces.h"
#include "drivers/lcm/piece_name.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/memory_file.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

namespace fs = std::filesystem;

void read_log(const std::string& path, std::size_t bytes) {
  try {
    EventLogReader reader(path);
    LogEvent event;
    std::int64_t position = 0;
    for (std::size_t count = 0; reader.next(&event); ++count) {
      if (count > bytes) throw Finding("more events than bytes");
      if (reader.position_bytes() <= position) throw Finding("the position does not increase");
      position = reader.position_bytes();
      if (reader.missing() < 0) throw Finding("a negative number of events is missing");
    }
  } catch (const EventLogError&) {
  }
}

void run_event_log(FuzzBytes bytes) { read_log(path_of_file_with(bytes), bytes.size()); }

// A folder that goes with the process.
class Folder {
 public:
  Folder() {
    std::string text = (fs::temp_directory_path() / "leonav-fuzz-XXXXXX").string();
    if (::mkdtemp(text.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = text;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(std::string_view name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

constexpr std::array<const char*, 6> kPieceNames = {
    "drive", "drive.part0002", "drive.part0003", "drive.part0002.kept", "drive.kept", "other"};

// A list of files: name, length in two bytes, bytes.
void run_journal(FuzzBytes input) {
  static const Folder folder;
  std::array<bool, kPieceNames.size()> written{};
  for (ByteScript script(input); !script.empty();) {
    const std::size_t name = script.byte() % kPieceNames.size();
    const std::size_t length = script.half();
    const FuzzBytes bytes = script.take(length);
    std::ofstream(folder.file(kPieceNames[name]), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    written[name] = true;
  }
  read_log(folder.path(), input.size());
  read_log(folder.file(kPieceNames[0]), input.size());
  read_log(folder.file(kPieceNames[1]), input.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (written[i]) fs::remove(folder.file(kPieceNames[i]));
  }
}

// Every name is one, and what was taken apart is put together again.
void run_piece_name(FuzzBytes bytes) {
  const std::string name(bytes.begin(), bytes.end());
  const PieceName parts = parse_piece_name(name);
  std::array<char, 512> text{};
  if (!format_piece_name(parts, text)) return;
  const PieceName again = parse_piece_name(text.data());
  if (name.find('\0') != std::string::npos) return;
  if (again.journal != parts.journal || again.number != parts.number || again.kept != parts.kept) {
    throw Finding("the name " + name + " of a piece becomes " + text.data());
  }
}

}  // namespace

std::vector<FuzzTarget> log_targets() {
  return {{"event_log", run_event_log}, {"journal", run_journal}, {"piece_name", run_piece_name}};
}

}  // namespace leonav::test
