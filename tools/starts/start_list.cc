#include "tools/starts/start_list.h"
#include "core/base/angle.h"

#include <iomanip>
#include <ostream>

namespace leonav {
namespace {

// Writes error and sigma in degrees; empty if there was no heading.
void write_sample(const std::optional<HeadingSample>& sample, std::ostream& out) {
  if (sample)
    out << ',' << sample->error / kDegree << ',' << sample->sigma / kDegree;
  else
    out << ",,";
}

}  // namespace

void write_start_list(std::span<const StartResult> results, std::ostream& out) {
  out << "gps_tow_s,way,aligned_after_s,heading_error_deg,heading_sigma_deg,error_at_30_s_deg,"
         "sigma_at_30_s_deg,false,carried_away,off_after_s,off_error_deg,off_sigma_deg,"
         "told_off_deg,restarts,noticed_after_s,error_when_noticed_deg,sigma_when_noticed_deg,"
         "driven_s,error_at_end_deg,sigma_at_end_deg\n";
  for (const StartResult& r : results) {
    const auto& first = r.heading.first();
    out << std::fixed << std::setprecision(3) << r.start.tow_s() << ',' << to_string(r.way) << ','
        << (first ? first->after_s : -1.0);
    write_sample(first, out);
    write_sample(r.heading.at_30_s(), out);
    out << ',' << (has_false_alignment(r.heading) ? 1 : 0) << ','
        << (has_diverged(r.heading) ? 1 : 0) << ',';
    const auto off = first_off(r.heading);
    if (off) out << off->after_s;
    write_sample(off, out);
    out << ',' << r.given_heading_error.value_or(0.0) / kDegree << ',' << r.restarts << ','
        << r.noticed_after_s;
    write_sample(r.when_noticed, out);
    out << ',' << r.driven_s;
    write_sample(r.heading.last(), out);
    out << '\n';
  }
}

}  // namespace leonav
