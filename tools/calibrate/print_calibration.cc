#include "tools/calibrate/print_calibration.h"

#include <cmath>
#include <ostream>

#include "tools/common/format.h"
#include "tools/common/learned_errors_text.h"

namespace leonav {
namespace {

constexpr double kWhole = 0.95;  // a log of which so large a share was used counts as whole

struct Row {
  Quantity quantity;
  double configured = 0.0, found = 0.0, sigma = 0.0;  // in the quantity's printed unit
  bool observed = false;
};

Row row_of(const CalibrationResult& calibration, std::size_t i) {
  const auto quantity = static_cast<Quantity>(i);
  const double unit = unit_of(quantity);
  return {quantity, values_of(calibration.configured)[i] / unit,
          values_of(calibration.found)[i] / unit, calibration.last.sigma[i] / unit,
          calibration.last.observed[i]};
}

// Returns why the log does not determine the quantity.
const char* reason_of(Quantity quantity, const CalibrationResult& calibration) {
  switch (quantity) {
    case Quantity::kRoll:
      if (calibration.wheeled) return "less than a minute of driving straight on";
      [[fallthrough]];
    case Quantity::kPitch:
    case Quantity::kYaw:
      return calibration.wheeled
                 ? "too vague, or the log's halves disagree: it takes driving at speed"
                 : "nothing tells how the vehicle goes (vehicle.non_holonomic off)";
    case Quantity::kArmDown:
      return "it takes tilting: steep ways, rolling in bends";
    case Quantity::kArmForward:
    case Quantity::kArmRight:
      return "it takes turns, with carriers or good Dopplers";
    case Quantity::kTimeOffset:
      return "it takes changes of speed and turns";
  }
  return "";
}

std::string vector_text(const Eigen::Vector3d& v, double unit, int decimals) {
  return format("[%.*f, %.*f, %.*f]", decimals, v.x() / unit, decimals, v.y() / unit, decimals,
                v.z() / unit);
}

std::string sigmas_text(const CalibrationResult& calibration, std::size_t first,
                        std::size_t count) {
  std::string text = "# 1 sigma";
  for (std::size_t i = first; i < first + count; ++i) {
    const Row row = row_of(calibration, i);
    text += (i > first ? ", " : " ") +
            (row.observed ? format("%.3f", row.sigma) : std::string("not observed, as configured"));
  }
  return text;
}

}  // namespace

void print_calibration(const CalibrationResult& calibration, std::ostream& out) {
  out << format("%d passes, %s; %.0f s straight on\n\n", calibration.passes,
                calibration.settled ? "settled" : "NOT SETTLED", calibration.straight_s)
      << "                        configured      found    1 sigma     change  in sigmas\n";
  std::string unknown, alone;
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const Row row = row_of(calibration, i);
    const std::string name(name_of(row.quantity));
    if (!row.observed) {
      out << format("%-22s  %10.3f  not observable in this log\n", name.c_str(), row.configured);
      unknown += "  " + name + ": " + reason_of(row.quantity, calibration) + "\n";
      continue;
    }
    const double change = row.found - row.configured;
    out << format("%-22s  %10.3f %10.3f %10.3f %10.3f %10.1f\n", name.c_str(), row.configured,
                  row.found, row.sigma, change, std::abs(change) / row.sigma);
    if (!calibration.compared[i]) alone += (alone.empty() ? "" : ", ") + name;
  }
  if (!alone.empty())
    out << "\nThe log's halves could not be compared, the sigma is the whole log's alone: " << alone
        << "\n";
  if (!unknown.empty()) out << "\nWhat this log does not tell:\n" << unknown;
  if (calibration.learned.learned) {
    out << "\nErrors as the filter has learned them, mean over the log (nothing to configure):\n"
        << learned_errors_text("codes", calibration.learned.code)
        << learned_errors_text("Dopplers", calibration.learned.doppler);
  }
  if (calibration.used_s < kWhole * calibration.length_s)
    out << format(
        "\nThe filter has started over in this log: what was found is of the last %.0f of %.0f s\n"
        "with an attitude. leonav-replay shows when and why (events).\n",
        calibration.used_s, calibration.length_s);
  const Installation& found = calibration.found;
  const double degree = unit_of(Quantity::kRoll);
  out << "\nvehicle:\n  lever_arm_b_m: " << vector_text(found.lever_arm_b, 1.0, 3) << "  "
      << sigmas_text(calibration, 0, 3)
      << "\n  mounting_rpy_deg: " << vector_text(found.mounting_rpy, degree, 3) << "  "
      << sigmas_text(calibration, 3, 3) << "\nimu:\n  time_offset_ms: "
      << format("%.2f", found.time_offset_s / unit_of(Quantity::kTimeOffset)) << "  "
      << sigmas_text(calibration, 6, 1) << "\n";
}

std::string json_of(const CalibrationResult& calibration) {
  std::string text = format("{\"passes\": %d, \"settled\": %s,\n \"used s\": ", calibration.passes,
                            calibration.settled ? "true" : "false") +
                     json_number(calibration.used_s, 1) +
                     ", \"with an attitude s\": " + json_number(calibration.length_s, 1);
  const auto add_learned = [&](const char* of, const ObservableErrors& errors) {
    const auto numbers = [](const LearnedError& error) {
      return "{\"sigma_factor\": " + json_number(error.sigma_factor, 3) +
             ", \"correlated_share\": " + json_number(error.correlated_share, 3) +
             ", \"correlation_time_s\": " + json_number(error.correlation_time_s, 2) + "}";
    };
    text += std::string(",\n \"learned ") + of + "\": " + numbers(errors.all);
    for (std::size_t i = 0; i < errors.classes.size(); ++i)
      text += std::string(",\n \"learned ") + of + ", " + std::string(kLearnedClassNames[i]) +
              "\": " + numbers(errors.classes[i]);
  };
  if (calibration.learned.learned) {
    add_learned("codes", calibration.learned.code);
    add_learned("Dopplers", calibration.learned.doppler);
  }
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const Row row = row_of(calibration, i);
    text += ",\n " + json_string(std::string(name_of(row.quantity))) +
            ": {\"configured\": " + json_number(row.configured, 5) +
            ", \"found\": " + json_number(row.found, 5) +
            ", \"sigma\": " + json_number(row.sigma, 5) +
            ", \"observed\": " + (row.observed ? "true" : "false") +
            ", \"compared\": " + (calibration.compared[i] ? "true}" : "false}");
  }
  return text + "}\n";
}

}  // namespace leonav
