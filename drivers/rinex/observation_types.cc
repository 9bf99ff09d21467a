#include "drivers/rinex/observation_types.h"

#include <algorithm>

namespace leonav {
namespace {

bool is_used_kind(char kind) { return kind == 'C' || kind == 'L' || kind == 'D' || kind == 'S'; }

struct Names2 {
  bool c1, p1, c2, p2;
};

void set_gps_2(char letter, char band, const Names2& have, ObservationType* type) {
  const SignalCode ca{'1', 'C'}, p1{'1', 'W'}, l2c{'2', 'X'}, p2{'2', 'W'};
  if (band == '5') {
    type->code = {'5', 'X'};
  } else if (letter == 'P' || letter == 'C') {
    type->code = band == '1' ? (letter == 'P' ? p1 : ca) : (letter == 'P' ? p2 : l2c);
  } else if (band == '1') {
    type->code = have.p1 && !have.c1 ? p1 : ca;
    if (have.p1 && have.c1) type->fallback = p1;
  } else {
    type->code = have.c2 && !have.p2 ? l2c : p2;
    if (have.p2 && have.c2) type->fallback = l2c;
  }
}

ObservationType type_2(char system, const std::string& name, const Names2& have) {
  ObservationType type;
  if (name.size() != 2) return type;
  const char letter = name[0], band = name[1];
  const char kind = letter == 'P' ? 'C' : letter;
  if (!is_used_kind(kind)) return type;
  const auto is_one_of = [band](std::string_view bands) {
    return bands.find(band) != std::string_view::npos;
  };
  if ((system == 'G' || system == 'L') && is_one_of("125")) {
    set_gps_2(letter, band, have, &type);
  } else if (system == 'E' && letter != 'P' && is_one_of("15678")) {
    type.code = {band, 'X'};
  } else if (system == 'C' && letter != 'P' && is_one_of("1267")) {
    type.code = band == '1' ? (have.c2 ? SignalCode{'1', 'X'} : SignalCode{'2', 'I'})
                            : SignalCode{band, 'I'};
  }
  type.kind = type.code.is_set() ? kind : '\0';
  return type;
}

}  // namespace

ObservationType observation_type_3(char system, std::string_view name, int version_hundredths) {
  ObservationType type;
  if (name.size() != 3 || !is_used_kind(name[0])) return type;
  const auto code = signal_from_string(name.substr(1));
  if (!code) return type;
  type.kind = name[0];
  type.code = *code;
  // RINEX 3.02 calls BeiDou's B1I band 1; before and after it is band 2. B1C (really band 1 since
  // 3.03) has no I or Q, so those mean B1I whatever the version.
  const bool is_b1i = code->attribute == 'I' || code->attribute == 'Q' ||
                      (code->attribute == 'X' && version_hundredths == 302);
  if (system == 'C' && code->band == '1' && is_b1i) type.code.band = '2';
  return type;
}

std::vector<ObservationType> observation_types_2(char system,
                                                 const std::vector<std::string>& names) {
  const auto has = [&names](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const Names2 have{has("C1"), has("P1"), has("C2"), has("P2")};
  std::vector<ObservationType> types;
  types.reserve(names.size());
  for (const std::string& name : names) types.push_back(type_2(system, name, have));
  return types;
}

}  // namespace leonav
