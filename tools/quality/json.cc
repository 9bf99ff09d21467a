// This unit writes a quality analysis as JSON: everything in the table, and every slip.
#include <cmath>

#include "core/base/angle.h"
#include "tools/common/format.h"
#include "tools/quality/internal/number.h"
#include "tools/quality/internal/slip_text.h"
#include "tools/quality/quality.h"

namespace leonav {
namespace {

std::string text(std::string_view word) { return json_string(std::string(word)); }

std::string cn0_json(const Cn0Distribution& cn0) {
  return format("{\"count\": %llu, \"mean\": ", number(cn0.count())) + json_number(cn0.mean(), 2) +
         ", \"p5\": " + json_number(cn0.percentile(0.05), 1) +
         ", \"p50\": " + json_number(cn0.percentile(0.5), 1) +
         ", \"p95\": " + json_number(cn0.percentile(0.95), 1) + "}";
}

std::string signal_json(const SignalQuality& s, bool with_bins) {
  const MultipathSum all = s.multipath.all();
  std::string out = format(
      "{\"codes\": %llu, \"carriers\": %llu, \"loss_of_lock\": %llu, \"half_cycles\": %llu, "
      "\"implausible_codes\": %llu, \"codes_without_carrier_pair\": %llu, ",
      number(s.codes), number(s.carriers), number(s.loss_of_lock), number(s.half_cycles),
      number(s.implausible), number(s.without_carriers));
  out += "\"cn0_dbhz\": " + cn0_json(s.cn0_all()) +
         ", \"multipath\": {\"rms_m\": " + json_number(all.rms_m(), 4) +
         format(
             ", \"samples\": %llu, \"arcs\": %llu, \"short_arcs\": %llu, "
             "\"short_arc_samples\": %llu}",
             number(all.samples), number(s.multipath.arcs), number(s.multipath.short_arcs),
             number(s.multipath.short_arc_samples));
  if (!with_bins) return out + "}";
  out += ", \"by_elevation\": [";
  bool first = true;
  for (std::size_t bin = 0; bin < kElevationBins; ++bin) {
    const MultipathSum& mp = s.multipath.bins[bin];
    if (s.cn0[bin].count() == 0 && mp.samples == 0) continue;
    out += first ? "\n    " : ",\n    ";
    first = false;
    out += "{\"elevation_deg\": " +
           (bin == kNoElevation ? "null" : format("[%zu, %zu]", 10 * bin, 10 * bin + 10));
    out += ", \"cn0_dbhz\": " + cn0_json(s.cn0[bin]) +
           ", \"multipath_rms_m\": " + json_number(mp.rms_m(), 4) +
           format(", \"multipath_samples\": %llu}", number(mp.samples));
  }
  return out + "]}";
}

std::string system_json(const SystemQuality& s) {
  const auto range = [](const CountRange& r) {
    return format("{\"mean\": %.3f, \"least\": %llu, \"most\": %llu}", r.mean(), number(r.least),
                  number(r.most));
  };
  return format("{\"satellites\": %llu, \"seen\": ", number(s.satellites)) + range(s.seen) +
         ", \"usable\": " + range(s.usable) + "}";
}

std::string dop_json(const DopRange& d) {
  return format("{\"epochs\": %llu, \"median\": ", number(d.epochs)) + json_number(d.median, 4) +
         ", \"p95\": " + json_number(d.p95, 4) + ", \"worst\": " + json_number(d.worst, 4) + "}";
}

std::string epochs_json(const Quality& q) {
  const EpochTimes& t = q.times;
  std::string out = format(
      " \"first\": {\"week\": %d, \"tow_s\": %.9f}, \"last\": {\"week\": %d, \"tow_s\": %.9f},\n",
      t.first.week(), t.first.tow_s(), t.last.week(), t.last.tow_s());
  out += format(
      " \"epochs\": %llu, \"interval_s\": %.3f, \"missing_epochs\": %.0f, \"gaps\": %llu, "
      "\"longest_gap_s\": %.3f,\n",
      number(t.epochs), t.interval_s, t.missing, number(t.gaps), t.longest_gap_s);
  out += format(
      " \"epochs_backwards\": %llu, \"epochs_malformed\": %llu, \"epochs_incomplete\": %llu, "
      "\"products_refused\": %llu, \"epochs_solved\": %llu, \"clock_jumps\": %llu, \"code_steps\": "
      "%llu,\n",
      number(t.backwards), number(q.inputs.refused_epochs), number(q.inputs.incomplete_epochs),
      number(q.inputs.refused_products), number(q.solved_epochs), number(q.clock_jumps),
      number(q.code_steps));
  out += std::string(" \"truncated\": ") + (q.inputs.truncated ? "true" : "false") +
         ", \"damage\": " + (q.inputs.damage.empty() ? "null" : json_string(q.inputs.damage)) +
         ",\n";
  return out + " \"elevation_mask_deg\": " +
         json_number(q.options.elevation_mask * kDegreesPerRadian, 3) + ",\n";
}

std::string satellites_json(const Quality& q) {
  std::string out = " \"satellites\": {";
  bool first = true;
  for (const auto& [id, s] : q.satellites) {
    out += (first ? "\n  " : ",\n  ") + text(to_string(id));
    first = false;
    out += format(
        ": {\"epochs\": %llu, \"usable_epochs\": %llu, \"followed_epochs\": %llu, \"slips\": %llu, "
        "\"interruptions\": %llu, \"half_cycle_open_epochs\": %llu, \"one_frequency\": %s, ",
        number(s.epochs), number(s.usable_epochs), number(s.followed), number(s.slips),
        number(s.interruptions), number(s.unresolved), s.one_frequency ? "true" : "false");
    out += "\"highest_elevation_deg\": " + json_number(s.highest_elevation * kDegreesPerRadian, 2) +
           ", \"reasons\": {";
    for (auto reason = s.reasons.begin(); reason != s.reasons.end(); ++reason) {
      out += (reason == s.reasons.begin() ? "" : ", ") + text(to_string(reason->first)) +
             format(": %llu", number(reason->second));
    }
    out += "}, \"signals\": {";
    for (auto signal = s.signals.begin(); signal != s.signals.end(); ++signal) {
      out += (signal == s.signals.begin() ? "\n   " : ",\n   ") + text(to_string(signal->first)) +
             ": " + signal_json(signal->second, false);
    }
    out += "}}";
  }
  return out + "},\n";
}

std::string slips_json(const Quality& q) {
  std::string out = " \"slip_totals\": {";
  const auto totals = slip_totals(q);
  for (const System system : kSystems) {
    const SlipTotals& t = totals[index_of(system)];
    out +=
        (system == kSystems.front() ? "" : ", ") + text(to_string(system)) +
        format(
            ": {\"followed\": %llu, \"slips\": %llu, \"slips_told\": %llu, \"interruptions\": "
            "%llu, ",
            number(t.followed), number(t.slips), number(t.flagged_slips), number(t.interruptions)) +
        "\"observations_per_slip\": " + json_number(t.observations_per_slip(), 1) + "}";
  }
  out += "},\n \"arc_ends\": [";
  for (std::size_t i = 0; i < q.breaks.size(); ++i) {
    const ArcBreak& one = q.breaks[i];
    out += format("%s\n  {\"week\": %d, \"tow_s\": %.3f, \"satellite\": ", i == 0 ? "" : ",",
                  one.time.week(), one.time.tow_s()) +
           text(to_string(one.satellite)) + ", \"signals\": " + text(signals_text(one)) +
           ", \"slip\": " + (is_slip(one.causes) ? "true" : "false") +
           ", \"causes\": " + text(causes_text(one.causes)) +
           ", \"elevation_deg\": " + json_number(one.elevation * kDegreesPerRadian, 2) + "}";
  }
  return out + "]\n";
}

}  // namespace

std::string to_json(const Quality& q) {
  std::string out = "{\"log\": " + json_string(q.log) + ",\n" + epochs_json(q) + " \"systems\": {";
  for (const System system : kSystems) {
    out += text(to_string(system)) + ": " + system_json(q.systems[index_of(system)]) + ",\n  ";
  }
  out += "\"all\": " + system_json(q.all_systems) + "},\n";
  out += " \"dop\": {\"gdop\": " + dop_json(q.gdop) + ", \"pdop\": " + dop_json(q.pdop) +
         ", \"hdop\": " + dop_json(q.hdop) + ", \"vdop\": " + dop_json(q.vdop) + "},\n";
  out += " \"signals\": {";
  for (auto signal = q.signals.begin(); signal != q.signals.end(); ++signal) {
    out +=
        (signal == q.signals.begin() ? "\n  " : ",\n  ") +
        text(std::string(to_string(signal->first.first)) + " " + to_string(signal->first.second)) +
        ": " + signal_json(signal->second, true);
  }
  return out + "},\n" + satellites_json(q) + slips_json(q) + "}\n";
}

}  // namespace leonav
