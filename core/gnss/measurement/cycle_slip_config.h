// This header holds the thresholds of the cycle slip detectors; few others stand beside their use.
#pragma once
namespace leonav {

// Sigmas hold from 30 degrees of elevation up and grow by elevation_factor() below. Limits "in
// sigma" apply to standardized quantities.
struct CycleSlipConfig {
  // --- Gaps. An arc survives the longer of max_gap_s and max_gap_intervals epoch intervals; for
  // LEO satellites the longer of max_gap_leo_s and 1.5 intervals. An arc of a single frequency
  // survives no epoch without its satellite, because no detector works across it. ---
  double max_gap_s = 10.0;
  double max_gap_leo_s = 3.0;
  double max_gap_intervals = 2.5;

  // --- Noise, 1 sigma of one signal ---
  double carrier_sigma_m = 0.002;
  double code_sigma_m = 0.4;
  double doppler_sigma_m_s = 0.05;

  // --- Ionosphere: slant delay on L1. The rate is a random walk around the trend seen so far. ---
  double ionosphere_rate_m_s = 0.0005;        // 1 sigma of the rate before any is observed
  double ionosphere_rate_walk_m_s = 0.00002;  // growth per sqrt(s)
  double ionosphere_rate_leo_m_s = 0.01;      // LEO: crosses the sky in minutes
  double ionosphere_rate_walk_leo_m_s = 0.0006;

  // --- Detectors ---
  bool use_geometry_free = true;
  double geometry_free_limit = 5.0;  // sigma
  // The deviation must also exceed this. Equal slips of one cycle on both frequencies of a pair
  // make 4 to 6 cm.
  double geometry_free_min_m = 0.02;
  // Bounds on a value and twice its sigma. Below the first bound a pair has not slipped, unless by
  // more than range_change_refuted_m. Below the second bound, which is half a cycle, it has not
  // slipped if the range change agrees.
  double geometry_free_quiet_m = 0.025;
  double geometry_free_clear_m = 0.1;
  bool use_melbourne_wuebbena = true;
  double melbourne_wuebbena_limit = 5.0;       // sigma
  double melbourne_wuebbena_min_cycles = 0.6;  // wide-lane cycles
  double joint_limit = 4.7;  // root of the sum of squares of the two above, in sigma
  bool use_doppler = true;
  double doppler_max_interval_s = 1.05;
  double doppler_limit = 5.0;  // sigma
  double doppler_min_cycles = 0.6;
  double jerk_m_s3 = 1.0;  // 1 sigma of the antenna's jerk along the line of sight
  bool use_lock_time = true;

  // --- Range change (geometric check) ---
  bool use_range_change = true;
  double range_change_limit = 5.0;   // sigma: a row beyond it has slipped
  double range_change_clear = 3.5;   // sigma: a row below it has not slipped
  double range_change_min_m = 0.03;  // smallest deviation called a slip
  // A row whose smallest detectable slip is above this confirms nothing; the bound is below a
  // cycle.
  double range_change_power_m = 0.15;
  // A pair whose geometry-free combination is quiet has not slipped by less than this: it is the
  // smallest slip that such a combination can hide.
  double range_change_refuted_m = 0.3;
  // 1 sigma of the change between two epochs of one system time's offset against the others.
  double inter_system_m = 0.01;
  double max_scale = 3.0;  // largest factor by which the rows' own scatter may raise their sigmas

  bool operator==(const CycleSlipConfig&) const = default;
};

}  // namespace leonav
