#include "drivers/blq/blq_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/angle.h"
#include "drivers/text/line_reader.h"
#include "drivers/text/nearest_word.h"

namespace leonav {
namespace {

constexpr int kRows = 6;
constexpr std::size_t kColumns = OceanLoading::kConstituents;
constexpr double kMaxAmplitude = 0.5;  // m
constexpr std::size_t kMaxStations = 20'000;
constexpr std::size_t kMaxListed = 20;
constexpr std::size_t kMaxName = 60;  // characters; the format's names have up to 24

constexpr std::array<const char*, kColumns> kColumnNames = {"M2", "S2", "N2", "K2", "K1", "O1",
                                                            "P1", "Q1", "MF", "MM", "SSA"};

struct Block {
  BlqStation station;
  int rows = 0;
  long fault_line = 0;  // of the first fault; 0: none
  std::string fault;
};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \t", begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::string upper(std::string_view text) {
  std::string result;
  for (const char c : text) {
    result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return result;
}

// A line that is neither a comment nor a row is a name. Stations of satellite laser ranging are
// named by numbers ("7840 13212S001"), so a row is a line that is mostly numbers, and more than
// one.
bool is_row(const std::vector<std::string_view>& words) {
  const auto numbers = std::count_if(words.begin(), words.end(), [](std::string_view word) {
    return parse_double(word).has_value();
  });
  return numbers >= 2 && 2 * static_cast<std::size_t>(numbers) > words.size();
}

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7f; });
}

std::size_t decimals(std::string_view word) {
  const std::size_t point = word.find('.');
  return point == std::string_view::npos ? 0 : word.size() - point;
}

void blame(Block* block, long line, const std::string& what) {
  if (block->fault_line != 0) return;
  block->fault_line = line;
  block->fault = what;
}

std::string missing_rows(const Block& block) {
  return "has " + std::to_string(block.rows) +
         " of its six rows (amplitudes up, west, south, then phases)";
}

class Reader {
 public:
  explicit Reader(const std::string& path) : lines_(path) {}

  std::vector<Block> read() {
    std::string_view line;
    while (lines_.next(line)) {
      const std::string_view text = trim(line);
      last_row_cut_ = false;
      if (text.empty()) continue;
      if (text.starts_with("$$")) {
        check_columns(text);
        continue;
      }
      const auto words = words_of(text);
      if (is_row(words)) {
        read_row(words);
      } else {
        begin_block(text);
      }
    }
    if (!blocks_.empty() && last_row_cut_) {
      blame(&blocks_.back(), lines_.line_number(),
            "last number of the file has fewer decimals than the others of its row");
    }
    end_block("the file's end");
    return std::move(blocks_);
  }

 private:
  // The comment is "$$ COLUMN ORDER:  M2  S2 ..."; other programs have used other orders.
  void check_columns(std::string_view comment) {
    const std::size_t at = upper(comment).find("COLUMN ORDER:");
    if (at == std::string::npos) return;
    const auto words = words_of(comment.substr(at + 13));
    const bool same =
        std::equal(words.begin(), words.end(), kColumnNames.begin(), kColumnNames.end(),
                   [](std::string_view word, const char* name) { return upper(word) == name; });
    if (!same) {
      lines_.fail(
          "columns are in another order than M2 S2 N2 K2 K1 O1 P1 Q1 MF MM SSA; have the "
          "file made in the BLQ format");
    }
  }

  void begin_block(std::string_view name) {
    end_block("here");
    if (blocks_.size() == kMaxStations) {
      lines_.fail("more than " + std::to_string(kMaxStations) +
                  " stations; this is no file of the BLQ format");
    }
    Block block;
    block.station.name = name.substr(0, kMaxName);
    block.station.line = lines_.line_number();
    blocks_.push_back(block);
  }

  void end_block(const std::string& where) {
    if (blocks_.empty() || blocks_.back().rows == kRows) return;
    blame(&blocks_.back(), lines_.line_number(), missing_rows(blocks_.back()) + " before " + where);
  }

  void read_row(const std::vector<std::string_view>& words) {
    if (blocks_.empty()) return;  // a row without a station's name before it
    Block& block = blocks_.back();
    const long line = lines_.line_number();
    if (block.rows == kRows) return blame(&block, line, "has more than six rows");
    const int row = block.rows++;
    if (words.size() != kColumns) {
      return blame(&block, line,
                   "row has " + std::to_string(words.size()) + " columns instead of eleven");
    }
    for (std::size_t i = 0; i < kColumns; ++i) {
      const auto value = parse_double(words[i]);
      if (!value) {
        return blame(&block, line, "'" + std::string(words[i].substr(0, 20)) + "' is no number");
      }
      if (const char* fault = blq_fault(row, *value)) {
        return blame(&block, line, std::string(words[i].substr(0, 20)) + ": " + fault);
      }
      block.station.rows(row, static_cast<Eigen::Index>(i)) = *value;
    }
    // A file cut off within its last number has fewer decimals there than elsewhere in the row.
    last_row_cut_ = decimals(words[kColumns - 1]) < decimals(words[0]);
  }

  LineReader lines_;
  std::vector<Block> blocks_;
  bool last_row_cut_ = false;
};

// Returns the stations that fit the name or, for an empty name, all that have more than a stray
// line of text.
std::vector<const Block*> fitting(const std::vector<Block>& blocks, std::string_view name) {
  const std::string wanted = upper(trim(name));
  std::vector<const Block*> whole, first_word;
  for (const Block& block : blocks) {
    const std::string there = upper(block.station.name);
    if (wanted.empty() ? block.rows > 0 : there == wanted) {
      whole.push_back(&block);
    } else if (upper(words_of(block.station.name).front()) == wanted) {
      first_word.push_back(&block);
    }
  }
  return whole.empty() ? first_word : whole;
}

std::string listed(const std::vector<const Block*>& blocks) {
  std::string text;
  for (std::size_t i = 0; i < std::min(blocks.size(), kMaxListed); ++i) {
    std::string name = blocks[i]->station.name;
    for (char& c : name) c = is_printable({&c, 1}) ? c : '?';
    text += (i == 0 ? "'" : ", '") + name + "'";
  }
  if (blocks.size() > kMaxListed) {
    text += " and " + std::to_string(blocks.size() - kMaxListed) + " more";
  }
  return text;
}

// Returns the message for a name that fits no station: the stations of the file, and the nearest
// name.
std::string absence(const std::vector<const Block*>& there, std::string_view name) {
  std::vector<std::string> names;
  for (const Block* block : there) names.push_back(upper(block->station.name));
  const auto near = nearest_word(upper(trim(name)), names);
  return "station '" + std::string(trim(name)) + "' is not in the file" +
         (near ? "; did you mean '" + *near + "'?" : std::string()) + "; there " +
         (there.size() == 1 ? "is " : "are ") + listed(there);
}

}  // namespace

const char* blq_fault(int row, double value) {
  if (row < 3 && !(value >= 0.0 && value <= kMaxAmplitude)) {
    return "no amplitude of a displacement, which is between 0 and 0.5 m";
  }
  if (row >= 3 && !(std::abs(value) <= 360.0)) return "no phase, which is within 360 degrees";
  return nullptr;
}

OceanLoading ocean_loading(const BlqRows& rows) {
  OceanLoading loading;
  loading.amplitude_m = rows.topRows<3>();
  loading.phase = rows.bottomRows<3>() * kDegree;
  return loading;
}

BlqStation read_blq(const std::string& path, std::string_view station) {
  const std::vector<Block> blocks = Reader(path).read();
  const auto there = fitting(blocks, "");
  if (there.empty()) {
    throw FileError(path, 0,
                    "holds no station with rows of numbers; give a file of the BLQ format");
  }
  const auto fits = fitting(blocks, station);
  if (fits.empty()) throw FileError(path, 0, absence(there, station));
  const Block& block = *fits.front();
  if (fits.size() > 1) {
    throw FileError(
        path, fits[1]->station.line,
        trim(station).empty() ? "more than one station; name that of the receiver: " + listed(fits)
        : upper(fits[1]->station.name) == upper(block.station.name)
            ? "station " + listed({fits[0]}) + " is there twice, first in line " +
                  std::to_string(block.station.line) + "; remove one"
            : "the name fits more than one station; give the whole name of one: " + listed(fits));
  }
  if (block.fault_line != 0) {
    throw FileError(path, block.fault_line,
                    "station " + listed({&block}) + ": " + block.fault + "; get the file again");
  }
  return block.station;
}

}  // namespace leonav
