// This unit prints the table of a quality analysis for people.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/angle.h"
#include "tools/common/format.h"
#include "tools/quality/internal/number.h"
#include "tools/quality/internal/slip_text.h"
#include "tools/quality/quality.h"

namespace leonav {
namespace {

constexpr std::size_t kSlipsShown = 20;

// Returns a number in `width` columns, a dash if it is not finite.
std::string cell(double value, int width, int decimals) {
  return std::isfinite(value) ? format("%*.*f", width, decimals, value) : format("%*s", width, "-");
}

std::string head(const Quality& q) {
  const EpochTimes& t = q.times;
  std::string out = q.log + "\n";
  out += format("  GPS week %d, %.1f s to week %d, %.1f s: %.1f min; %llu epochs", t.first.week(),
                t.first.tow_s(), t.last.week(), t.last.tow_s(),
                seconds_between(t.last, t.first) / 60.0, number(t.epochs));
  if (t.epochs > 1) {
    out += format(" at %g s, %.0f missing in %llu gaps", t.interval_s, t.missing, number(t.gaps));
    if (t.gaps > 0) out += format(" (longest %.1f s)", t.longest_gap_s);
  }
  out += "\n";
  const auto note = [&](std::uint64_t count, const char* what) {
    if (count > 0) out += format("  %llu %s\n", number(count), what);
  };
  note(t.backwards, "epochs left out: out of order in time");
  note(q.inputs.refused_epochs, "epochs left out: malformed messages");
  note(q.inputs.incomplete_epochs, "epochs with malformed observations, which were left out");
  note(q.inputs.refused_products, "ephemerides, orbits or ionosphere messages refused");
  note(q.clock_jumps, "jumps of the receiver's clock by whole milliseconds");
  note(q.code_steps, "steps of all codes against the carriers (clock of the codes), taken out");
  if (q.inputs.truncated) out += "  the log's last message is cut short\n";
  if (!q.inputs.damage.empty())
    out += "  the log is damaged, what follows is not judged: " + q.inputs.damage + "\n";
  return out;
}

std::string satellites_and_dop(const Quality& q) {
  std::string out =
      format("\nSatellites per epoch (usable: orbit known, healthy, above %.0f deg)\n",
             q.options.elevation_mask * kDegreesPerRadian);
  out += "              in all   seen: mean  min  max   usable: mean  min  max\n";
  const auto row = [&](const std::string& name, const SystemQuality& s) {
    if (s.satellites == 0) return;
    out += format("  %-10s%8llu%14.1f%5llu%5llu%15.1f%5llu%5llu\n", name.c_str(),
                  number(s.satellites), s.seen.mean(), number(s.seen.least), number(s.seen.most),
                  s.usable.mean(), number(s.usable.least), number(s.usable.most));
  };
  for (const System system : kSystems)
    row(std::string(to_string(system)), q.systems[index_of(system)]);
  row("all", q.all_systems);
  out += format("  point solution in %llu of %llu epochs (%.1f %%)\n", number(q.solved_epochs),
                number(q.times.epochs),
                100.0 * static_cast<double>(q.solved_epochs) / static_cast<double>(q.times.epochs));
  out += "\nDilution of precision, usable satellites, a clock per system\n";
  out += "            median     95 %    worst   epochs\n";
  const auto dop = [&](const char* name, const DopRange& d) {
    out += format("  %-8s%s%s%s%9llu\n", name, cell(d.median, 8, 2).c_str(),
                  cell(d.p95, 9, 2).c_str(), cell(d.worst, 9, 2).c_str(), number(d.epochs));
  };
  dop("GDOP", q.gdop);
  dop("PDOP", q.pdop);
  dop("HDOP", q.hdop);
  dop("VDOP", q.vdop);
  return out;
}

std::string signals(const Quality& q) {
  std::string out =
      "\nSignals: C/N0 in dB-Hz; MP: code multipath and noise in m, mean of each arc removed\n"
      "                     codes carriers    LLI   half   C/N0   5 %  50 %  95 %  MP rms   arcs"
      "  no MP\n";
  for (const auto& [key, s] : q.signals) {
    const Cn0Distribution cn0 = s.cn0_all();
    const std::string name = std::string(to_string(key.first)) + " " + to_string(key.second);
    out +=
        format("  %-13s%11llu%9llu%7llu%7llu%s%s%s%s%s%7llu%7llu\n", name.c_str(), number(s.codes),
               number(s.carriers), number(s.loss_of_lock), number(s.half_cycles),
               cell(cn0.mean(), 7, 1).c_str(), cell(cn0.percentile(0.05), 6, 1).c_str(),
               cell(cn0.percentile(0.5), 6, 1).c_str(), cell(cn0.percentile(0.95), 6, 1).c_str(),
               cell(s.multipath.all().rms_m(), 8, 3).c_str(), number(s.multipath.arcs),
               number(s.without_carriers + s.multipath.short_arc_samples));
  }
  out += format("  no MP: codes without a pair of carriers, or in arcs of fewer than %llu epochs\n",
                number(MultipathLevels::kMinSamples));
  std::string alone;
  for (const auto& [id, satellite] : q.satellites)
    if (satellite.one_frequency) alone += " " + to_string(id);
  if (!alone.empty()) out += "  never two carriers, so no MP at all:" + alone + "\n";
  return out;
}

std::string elevations(const Quality& q) {
  std::string heading = "  elevation    ";
  for (int low = 0; low < 90; low += 10) heading += format("%4d-%-3d", low, low + 10);
  std::string out = "\nMP rms (m) by elevation (deg)\n" + heading + " unknown\n";
  std::string cn0 = "\nC/N0 (dB-Hz): mean by elevation (deg)\n" + heading + " unknown\n";
  for (const auto& [key, s] : q.signals) {
    const std::string name = std::string(to_string(key.first)) + " " + to_string(key.second);
    std::string mp_row = format("  %-13s", name.c_str()), cn0_row = mp_row;
    for (std::size_t bin = 0; bin < kElevationBins; ++bin) {
      mp_row += cell(s.multipath.bins[bin].rms_m(), 8, 3);
      cn0_row += cell(s.cn0[bin].mean(), 8, 1);
    }
    if (s.multipath.all().samples > 0) out += mp_row + "\n";
    if (s.cn0_all().count() > 0) cn0 += cn0_row + "\n";
  }
  return out + cn0;
}

std::string without_orbit(const Quality& q) {
  std::string out;
  for (const auto& [id, satellite] : q.satellites) {
    for (const auto& [reason, epochs] : satellite.reasons) {
      if (is_usable(reason) || reason == Reason::kLowElevation) continue;
      out +=
          format("  %-5s%-20s%8llu of %llu epochs\n", to_string(id).c_str(),
                 std::string(to_string(reason)).c_str(), number(epochs), number(satellite.epochs));
    }
  }
  return out.empty() ? "" : "\nSatellites seen but left out, other than below the mask\n" + out;
}

std::string satellites(const Quality& q) {
  std::string out =
      "\nSatellites: per signal C/N0 mean (dB-Hz) and MP rms (m)\n"
      "       epochs  usable  top deg   slips  signals\n";
  for (const auto& [id, s] : q.satellites) {
    out += format("  %-5s%6llu%8llu%s%8llu ", to_string(id).c_str(), number(s.epochs),
                  number(s.usable_epochs),
                  cell(s.highest_elevation * kDegreesPerRadian, 9, 1).c_str(), number(s.slips));
    for (const auto& [code, signal] : s.signals) {
      out += "  " + to_string(code) + cell(signal.cn0_all().mean(), 5, 1) +
             cell(signal.multipath.all().rms_m(), 6, 2);
    }
    out += "\n";
  }
  return out;
}

}  // namespace

std::string to_table(const Quality& quality) {
  return head(quality) + satellites_and_dop(quality) + signals(quality) + elevations(quality) +
         without_orbit(quality) + satellites(quality) + slips_table(quality, kSlipsShown);
}

}  // namespace leonav
