// This unit prints counts of integrity: a table for people, JSON for programs.
#include "tools/common/format.h"
#include "tools/evaluate/integrity.h"
#include "tools/evaluate/internal/clopper_pearson.h"

namespace leonav {
namespace {

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

double percent_at_most(std::size_t part, std::size_t whole) {
  return 100.0 * upper_bound_of_share(part, whole);
}

std::string limit_line(const AlertLimitCounts& limit, const IntegrityCounts& counts) {
  return format(
      "    alert limit %6.2f m: available %7.3f %%; hazardous %zu epochs in %zu blocks (at most "
      "%.3f %%)\n",
      limit.limit_m, percent(limit.available(), counts.expected), limit.hazardous,
      limit.hazardous_blocks, percent_at_most(limit.hazardous_blocks, counts.blocks));
}

std::string quantity_lines(const char* name, const IntegrityCounts& counts, double block_s) {
  if (counts.epochs == 0) return format("  %-11sno level, or no truth\n", name);
  std::string out = format(
      "  %-11s%zu epochs with a level, of %zu expected; misleading %zu (%.4f %%, at most %.4f "
      "%%)\n",
      name, counts.epochs, counts.expected, counts.misleading,
      percent(counts.misleading, counts.epochs), percent_at_most(counts.misleading, counts.epochs));
  out += format(
      "    blocks of %g s: %zu of %zu misleading (at most %.3f %%); largest error %.2f of its "
      "level\n",
      block_s, counts.misleading_blocks, counts.blocks,
      percent_at_most(counts.misleading_blocks, counts.blocks), counts.largest_ratio);
  for (const AlertLimitCounts& limit : counts.limits) out += limit_line(limit, counts);
  return out;
}

std::string limit_json(const AlertLimitCounts& limit) {
  return format(
      "{\"limit_m\": %g, \"nominal\": %zu, \"misleading\": %zu, \"hazardous\": %zu, "
      "\"unavailable\": %zu, \"unavailable_misleading\": %zu, \"hazardous_blocks\": %zu}",
      limit.limit_m, limit.nominal, limit.misleading, limit.hazardous, limit.unavailable,
      limit.unavailable_misleading, limit.hazardous_blocks);
}

// Returns the lists that other levels and diagrams are counted from, each with its smallest first.
std::string histograms_json(const IntegrityCounts& counts) {
  std::string out = "],\n   \"multiples\": [";
  const char* comma = "";
  for (const auto& [tenths, of] : counts.multiples) {
    out += format("%s[%d, %zu, %zu]", comma, tenths, of.epochs, of.blocks);
    comma = ", ";
  }
  out += "],\n   \"diagram\": [";
  comma = "";
  for (const auto& [bins, epochs] : counts.diagram) {
    out += format("%s[%d, %d, %zu]", comma, bins.first, bins.second, epochs);
    comma = ", ";
  }
  return out + "]}";
}

std::string quantity_json(const char* name, const IntegrityCounts& counts) {
  std::string out = format(
      ",\n  \"%s\": {\"expected\": %zu, \"epochs\": %zu, \"misleading\": %zu, \"blocks\": %zu, "
      "\"misleading_blocks\": %zu, \"largest_ratio\": %.5f, \"observed_s\": %.3f,\n   "
      "\"misleading_at_most\": %.8g, "
      "\"misleading_blocks_at_most\": %.8g, \"limits\": [",
      name, counts.expected, counts.epochs, counts.misleading, counts.blocks,
      counts.misleading_blocks, counts.largest_ratio, counts.observed_s,
      upper_bound_of_share(counts.misleading, counts.epochs),
      upper_bound_of_share(counts.misleading_blocks, counts.blocks));
  for (std::size_t i = 0; i < counts.limits.size(); ++i)
    out += (i == 0 ? "\n    " : ",\n    ") + limit_json(counts.limits[i]);
  return out + histograms_json(counts);
}

}  // namespace

std::string to_table(const std::vector<IntegrityEvaluation>& evaluations,
                     const IntegrityOptions& options) {
  std::string out;
  for (const IntegrityEvaluation& e : evaluations) {
    out += e.label + "\n" + quantity_lines("horizontal", e.horizontal, options.block_s) +
           quantity_lines("vertical", e.vertical, options.block_s) +
           quantity_lines("heading", e.heading, options.block_s);
  }
  return out +
         "misleading: the error exceeds its level. hazardous: it exceeds the alert limit, the "
         "level "
         "does not.\nat most: the upper bound at 95 %, for independent trials; neighbouring epochs "
         "are not, blocks nearly.\n";
}

std::string to_json(const std::vector<IntegrityEvaluation>& evaluations,
                    const IntegrityOptions& options) {
  std::string out = "[\n";
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const IntegrityEvaluation& e = evaluations[i];
    out +=
        format(" {\"label\": %s, \"block_s\": %g", json_string(e.label).c_str(), options.block_s);
    out += quantity_json("horizontal", e.horizontal) + quantity_json("vertical", e.vertical) +
           quantity_json("heading", e.heading) + "}";
    out += i + 1 < evaluations.size() ? ",\n" : "\n";
  }
  return out + "]\n";
}

}  // namespace leonav
