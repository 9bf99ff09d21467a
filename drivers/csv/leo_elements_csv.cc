#include "drivers/csv/leo_elements_csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/csv/csv_writer.h"

namespace leonav {
namespace {

// The plain numbers of a row and where they belong.
struct ElementColumn {
  const char* name;
  double Ephemeris::*value;
};
constexpr std::array<ElementColumn, 17> kRequired = {{{"sqrt_a_sqrt_m", &Ephemeris::sqrt_a},
                                                      {"eccentricity", &Ephemeris::eccentricity},
                                                      {"m0_rad", &Ephemeris::m0},
                                                      {"delta_n_rad_s", &Ephemeris::delta_n},
                                                      {"omega0_rad", &Ephemeris::omega0},
                                                      {"omega_dot_rad_s", &Ephemeris::omega_dot},
                                                      {"i0_rad", &Ephemeris::i0},
                                                      {"i_dot_rad_s", &Ephemeris::i_dot},
                                                      {"omega_rad", &Ephemeris::omega},
                                                      {"cuc_rad", &Ephemeris::cuc},
                                                      {"cus_rad", &Ephemeris::cus},
                                                      {"crc_m", &Ephemeris::crc},
                                                      {"crs_m", &Ephemeris::crs},
                                                      {"cic_rad", &Ephemeris::cic},
                                                      {"cis_rad", &Ephemeris::cis},
                                                      {"af0_s", &Ephemeris::af0},
                                                      {"af1_s_s", &Ephemeris::af1}}};
constexpr std::array<ElementColumn, 3> kRates = {{{"a_dot_m_s", &Ephemeris::a_dot},
                                                  {"delta_n_dot_rad_s2", &Ephemeris::delta_n_dot},
                                                  {"af2_s_s2", &Ephemeris::af2}}};
// As the satellites broadcast no prediction of it (Ephemeris::accuracy_m).
constexpr double kNoAccuracy = -1.0;

class ElementRows {
 public:
  explicit ElementRows(const std::string& path)
      : rows_(path, kLeoElementsColumns, kLeoElementsColumns) {}

  bool next() { return rows_.next(); }
  // Empty: the row is bad, and has been counted.
  std::optional<Ephemeris> read();
  CsvReport finish() { return rows_.finish(); }

 private:
  double required(const char* name) {
    const int column = rows_.column(name);
    if (rows_.blank(column)) rows_.mark_bad(std::string("has no ").append(name));
    return rows_.number(column).value_or(0.0);
  }
  double optional(const char* name, double otherwise) {
    return rows_.number(rows_.column(name)).value_or(otherwise);
  }
  std::uint16_t count(const char* name, double otherwise);
  GpsTime near(const GpsTime& toe, double tow_s) const;

  CsvRows rows_;
};

std::uint16_t ElementRows::count(const char* name, double otherwise) {
  constexpr double kMost = 65535.0;
  const double value = optional(name, otherwise);
  if (!(value >= 0.0 && value <= kMost) || value != std::floor(value)) {
    rows_.mark_bad("'" + std::string(name) + "' must be a whole number from 0 to 65535");
    return 0;
  }
  return static_cast<std::uint16_t>(value);
}

// The instant nearest to toe that has this time of week.
GpsTime ElementRows::near(const GpsTime& toe, double tow_s) const {
  return toe.plus_seconds(std::remainder(tow_s - toe.tow_s(), double{kSecondsPerWeek}));
}

std::optional<Ephemeris> ElementRows::read() {
  Ephemeris e;
  const std::string name(rows_.text(rows_.column("satellite")));
  const auto satellite = satellite_from_string(name);
  if (!satellite || satellite->system != System::kLeo) {
    rows_.mark_bad("the satellite must be named L01 to O99 (docs/design.md, \"Files\")");
  } else {
    e.satellite = *satellite;
  }
  e.toe = rows_.time(rows_.column("gps_week"), rows_.column("toe_tow_s"));
  const double transmission_s = required("transmission_tow_s");
  const double toc_s = optional("toc_tow_s", e.toe.is_set() ? e.toe.tow_s() : 0.0);
  constexpr double kWeek_s = kSecondsPerWeek;
  for (const double tow_s : {transmission_s, toc_s}) {
    if (!(tow_s >= 0.0 && tow_s <= kWeek_s)) rows_.mark_bad("a time of week is out of range");
  }
  for (const ElementColumn& one : kRequired) e.*one.value = required(one.name);
  for (const ElementColumn& one : kRates) e.*one.value = optional(one.name, 0.0);
  e.issue = count("issue", 0.0);
  e.issue_clock = count("issue_clock", e.issue);
  e.health = count("health", 0.0);
  e.accuracy_m = optional("accuracy_m", kNoAccuracy);
  if (!rows_.bad()) {
    e.toc = near(e.toe, toc_s);
    e.transmission_time = near(e.toe, transmission_s);
    if (!is_sane(e))
      rows_.mark_bad("no LEO satellite can have these elements; are the units right?");
  }
  if (!rows_.bad()) return e;
  rows_.skip();
  return std::nullopt;
}

// With as few digits as give the same number again.
std::string exact(double value) {
  std::array<char, 400> buffer;  // the largest double has 309 digits
  std::string text;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  if (error == std::errc()) text.append(buffer.data(), end);
  return text;
}

}  // namespace

LeoElementsCsv read_leo_elements_csv(const std::string& path) {
  ElementRows rows(path);
  LeoElementsCsv file;
  while (rows.next()) {
    if (const auto ephemeris = rows.read()) file.ephemerides.push_back(*ephemeris);
  }
  file.report = rows.finish();
  return file;
}

void write_leo_elements_csv(const std::string& path, std::span<const Ephemeris> ephemerides) {
  std::string header(kLeoElementsColumns);
  header.append(",").append(kLeoElementsOptionalColumns);
  CsvWriter writer(path, header);
  for (const Ephemeris& e : ephemerides) {
    if (e.satellite.system != System::kLeo) continue;
    writer.text(to_string(e.satellite)).time(e.toe);
    writer.text(exact(e.transmission_time.tow_s()));
    for (const ElementColumn& one : kRequired) writer.text(exact(e.*one.value));
    for (const ElementColumn& one : kRates) writer.text(exact(e.*one.value));
    writer.text(exact(e.toc.tow_s()));
    for (const int count : {int{e.issue}, int{e.issue_clock}, int{e.health}}) {
      writer.text(std::to_string(count));
    }
    writer.text(exact(e.accuracy_m));
    writer.end_row();
  }
  writer.close();
}

}  // namespace leonav
