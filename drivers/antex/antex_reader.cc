#include "drivers/antex/antex_reader.h"

#include <algorithm>
#include <optional>

#include "drivers/antex/antex_antenna.h"
#include "drivers/text/line_reader.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxProblems = 20;
// Width of the type in the name's twenty characters; the radome follows.
constexpr std::size_t kTypeWidth = 16;

std::string_view type_of(std::string_view name) { return trim(name.substr(0, kTypeWidth)); }
std::string_view radome_of(std::string_view name) { return trim(name.substr(kTypeWidth)); }

// The reader takes one file; its members hold the contents of the lines read so far.
class Reader {
 public:
  Reader(const std::string& path, const AntexSelection& selection)
      : lines_(path), time_(selection.time), wanted_(antenna_name(selection.receiver_antenna)) {
    if (!wanted_.empty()) file_.match = ReceiverMatch::kAbsent;
  }

  AntexFile read() {
    read_header();
    std::string_view line;
    while (lines_.next(line)) read_line(line);
    if (antenna_) {
      file_.truncated = true;
      damaged("file ends within an antenna");
    }
    if (file_.satellites.empty() && file_.receiver.empty()) refuse_empty();
    return std::move(file_);
  }

 private:
  void read_header() {
    std::string_view line;
    if (!lines_.next(line) || trim(columns(line, 60, 20)) != "ANTEX VERSION / SYST") {
      throw FileError(lines_.path(), 1,
                      "does not begin with ANTEX VERSION / SYST; expected an ANTEX file");
    }
    const auto version = parse_double(columns(line, 0, 8));
    if (!version || *version < 1.0 || *version >= 2.0) {
      lines_.fail("ANTEX version is unreadable or unknown; versions 1.x are read");
    }
    bool has_type = false;
    while (lines_.next(line)) {
      const std::string_view label = trim(columns(line, 60, 20));
      if (label == "PCV TYPE / REFANT") {
        has_type = true;
        if (columns(line, 0, 1) != "A") {
          lines_.fail("models are relative to another antenna; use a file of absolute ones");
        }
      } else if (label == "END OF HEADER") {
        if (!has_type) lines_.fail("header has no PCV TYPE / REFANT; take the file anew");
        return;
      }
    }
    throw FileError(lines_.path(), lines_.line_number(), "ends within its header; take it anew");
  }

  void read_line(std::string_view line) {
    const std::string_view label = trim(columns(line, 60, 20));
    if (label == "START OF ANTENNA") {
      if (antenna_) damaged("START OF ANTENNA before the last one's end; that one is left out");
      antenna_.emplace();
      is_damaged_ = false;
    } else if (!antenna_ || is_damaged_) {
      if (label == "END OF ANTENNA") antenna_.reset();
    } else if (label == "END OF ANTENNA") {
      if (const auto problem = antenna_->finish()) {
        damaged(*problem);
      } else {
        take(*antenna_);
      }
      antenna_.reset();
    } else if (const auto problem = antenna_->line(line)) {
      damaged(*problem);
    }
  }

  // A damaged antenna excludes only itself and counts once.
  void damaged(const std::string& what) {
    if (is_damaged_) return;
    is_damaged_ = true;
    ++file_.damaged;
    if (file_.problems.size() < kMaxProblems)
      file_.problems.push_back({lines_.line_number(), what});
  }

  void take(const AntexAntenna& antenna) {
    if (antenna.is_satellite()) {
      take_satellite(antenna);
    } else {
      take_receiver(antenna);
    }
  }

  void take_satellite(const AntexAntenna& antenna) {
    if (!antenna.satellite()) {
      ++file_.other_system;
      return;
    }
    const bool too_early = antenna.valid_from().is_set() && time_ < antenna.valid_from();
    const bool too_late = antenna.valid_until().is_set() && time_ > antenna.valid_until();
    if (time_.is_set() && (too_early || too_late)) {
      ++file_.not_valid;
      return;
    }
    ++file_.satellite_antennas;
    count(antenna);
    file_.satellites.insert(file_.satellites.end(), antenna.patterns().begin(),
                            antenna.patterns().end());
  }

  // Takes the same radome before NONE, the type's mean before a single antenna's calibration, and
  // of equals the first one.
  void take_receiver(const AntexAntenna& antenna) {
    if (wanted_.empty() || type_of(antenna.type()) != type_of(wanted_)) return;
    const bool exact = radome_of(antenna.type()) == radome_of(wanted_);
    if (!exact && radome_of(antenna.type()) != "NONE") return;
    const int rank = (exact ? 2 : 0) + (antenna.serial().empty() ? 1 : 0);
    if (rank <= rank_ || antenna.patterns().empty()) return;
    rank_ = rank;
    file_.match = exact ? ReceiverMatch::kExact : ReceiverMatch::kWithoutRadome;
    file_.receiver = antenna.patterns();
    file_.receiver_found = antenna.type();
    count(antenna);
  }

  void count(const AntexAntenna& antenna) {
    file_.other_system += static_cast<std::uint64_t>(antenna.other_system_bands());
    file_.unknown_band += static_cast<std::uint64_t>(antenna.unknown_bands());
    file_.coarsened += static_cast<std::uint64_t>(antenna.coarsened());
  }

  [[noreturn]] void refuse_empty() const {
    std::string why = "holds no antenna that was asked for (";
    why += std::to_string(file_.not_valid) + " of satellites at other times, " +
           std::to_string(file_.other_system) + " of systems not used, " +
           std::to_string(file_.damaged) + " damaged";
    if (!file_.problems.empty()) {
      why += ", the first at line " + std::to_string(file_.problems[0].line) + ": " +
             file_.problems[0].what;
    }
    throw FileError(lines_.path(), 0, why + "); check that it is the right and complete file");
  }

  LineReader lines_;
  GpsTime time_;
  std::string wanted_;
  AntexFile file_;
  std::optional<AntexAntenna> antenna_;
  bool is_damaged_ = false;
  int rank_ = -1;
};

}  // namespace

std::string antenna_name(std::string_view text) {
  const std::string_view whole = trim(text);
  if (whole.empty()) return {};
  // The radome of a complete name is in the last four columns; otherwise it is the last word.
  std::string_view type = whole, radome = "NONE";
  const auto blank = whole.find_last_of(" \t");
  if (whole.size() > kTypeWidth && whole[kTypeWidth - 1] == ' ') {
    type = type_of(whole);
    radome = radome_of(whole);
  } else if (blank != std::string_view::npos && whole.size() - blank <= 5) {
    type = trim(whole.substr(0, blank));
    radome = whole.substr(blank + 1);
  }
  std::string name(kTypeWidth + 4, ' ');
  type.copy(name.data(), kTypeWidth);
  radome.copy(name.data() + kTypeWidth, 4);
  return name;
}

AntexFile read_antex(const std::string& path, const AntexSelection& selection) {
  return Reader(path, selection).read();
}

}  // namespace leonav
