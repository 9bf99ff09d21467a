// This unit measures the quality of a log's GNSS measurements: satellites, geometry, multipath,
// C/N0, slips.
#pragma once
#include <array>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "tools/quality/input_log.h"
#include "tools/quality/internal/carrier_streams.h"
#include "tools/quality/internal/census.h"
#include "tools/quality/internal/distribution.h"
#include "tools/quality/internal/multipath.h"

namespace leonav {

// Settings of an analysis.
struct QualityOptions {
  std::string prefix{kDefaultChannelPrefix};
  double elevation_mask = default_gnss_config().elevation_mask;  // rad; of usable satellites
  BandPlan bands;  // carriers; of LEO satellites as configured
  // Rows for plots are kept of every k-th epoch, so that there are at most this many; 0: no rows.
  std::uint64_t plot_epochs = 0;
};

// Quality of one signal, of one satellite or summed over a system.
struct SignalQuality {
  std::uint64_t codes = 0, carriers = 0;
  std::uint64_t loss_of_lock = 0, half_cycles = 0;  // flags that the receiver has set
  std::array<Cn0Distribution, kElevationBins> cn0;
  MultipathOfSignal multipath;
  std::uint64_t implausible = 0;       // codes out of physical range
  std::uint64_t without_carriers = 0;  // codes that no pair of carriers could level
  Cn0Distribution cn0_all() const;
  void add(const SignalQuality& other);
};

// Quality of one satellite.
struct SatelliteQuality {
  std::uint64_t epochs = 0, usable_epochs = 0;
  std::map<Reason, std::uint64_t> reasons;                              // of each epoch
  double highest_elevation = std::numeric_limits<double>::quiet_NaN();  // rad
  std::uint64_t followed = 0;    // epochs with carriers on which an arc was tracked
  std::uint64_t unresolved = 0;  // those among them with an ambiguous half cycle
  std::uint64_t slips = 0, flagged_slips = 0, interruptions = 0;  // flagged: by the receiver
  bool one_frequency = false;  // no second carrier in the whole log: no multipath combination
  std::map<SignalCode, SignalQuality> signals;
};

// Smallest, mean and largest count over the epochs.
struct CountRange {
  std::uint64_t epochs = 0, sum = 0, least = 0, most = 0;
  void add(std::uint64_t count);
  double mean() const;
};

// Quality of one system.
struct SystemQuality {
  std::uint64_t satellites = 0;
  CountRange seen, usable;
};

// One epoch, for plots.
struct EpochQuality {
  GpsTime time;
  bool solved = false;
  std::array<std::uint8_t, kSystemCount> seen{}, usable{};
  Dop dop;
};

// One signal at one epoch, for plots.
struct SignalSample {
  GpsTime time;
  SatelliteId satellite;
  SignalCode code;
  float elevation = 0.0F, azimuth = 0.0F;  // rad; NaN: not known
  float cn0_dbhz = 0.0F;
  float multipath_m = 0.0F;  // level removed; NaN: none
};

// Range of one dilution of precision.
struct DopRange {
  std::uint64_t epochs = 0;                     // with a value
  double median = 0.0, p95 = 0.0, worst = 0.0;  // NaN: none
};

// The whole analysis.
struct Quality {
  std::string log;
  QualityOptions options;
  InputCounts inputs;
  EpochTimes times;
  std::uint64_t solved_epochs = 0;
  std::uint64_t clock_jumps = 0;  // by whole milliseconds
  std::uint64_t code_steps = 0;   // of all codes against the carriers, removed (CodeSteps)
  std::map<SatelliteId, SatelliteQuality> satellites;
  std::array<SystemQuality, kSystemCount> systems;
  SystemQuality all_systems;
  std::map<std::pair<System, SignalCode>, SignalQuality> signals;  // sums over satellites
  DopRange gdop, pdop, hdop, vdop;
  std::vector<ArcBreak> breaks;  // slips and interruptions, in order of time
  std::vector<EpochQuality> plot_epochs;
  std::vector<SignalSample> plot_samples;
};

// Analyses a log. Throws EventLogError as read_inputs() does, and std::runtime_error for a log
// without a GNSS epoch.
Quality analyse_quality(const std::string& log, const QualityOptions& options,
                        std::ostream* progress);

// These format the analysis as a table for people and as JSON.
std::string to_table(const Quality& quality);
std::string to_json(const Quality& quality);
// Writes epochs.csv, signals.csv and slips.csv, which leonav-quality-plots draws, to `folder`,
// which must exist. Throws std::runtime_error if one cannot be written.
void write_plot_tables(const Quality& quality, const std::string& folder);

}  // namespace leonav
