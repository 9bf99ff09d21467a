// This unit computes code multipath and noise from code and carriers of two frequencies.
//
//   MP_i = P_i - (1 + 2/(a-1)) L_i + 2/(a-1) L_j,  a = f_i^2 / f_j^2, in metres
//
// (L. H. Estey and C. M. Meertens, TEQC: The Multi-Purpose Toolkit for GPS/GLONASS Data, GPS
// Solutions 3(1), 1999, eqs. 6 and 7.)
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/gnss/signals/observation.h"

namespace leonav {

// Returns the multipath combination of one epoch, m, from metres and hertz.
//
// Geometry, clocks, troposphere and first-order ionosphere cancel. The multipath and noise of the
// code remain, and a constant per arc (ambiguities and delays). MP1 of the paper has i = 1, j = 2;
// MP2 has i = 2, j = 1.
double multipath_combination_m(double code_m, double own_carrier_m, double other_carrier_m,
                               double own_hz, double other_hz);

// Elevation bins of 10 degrees, and one for unknown elevations.
inline constexpr std::size_t kElevationBins = 10;
inline constexpr std::size_t kNoElevation = 9;
std::size_t elevation_bin(double elevation);  // rad; NaN: kNoElevation; below 0: the lowest

// Sum over arcs of the squares about each arc's mean.
struct MultipathSum {
  std::uint64_t samples = 0;
  double squares = 0.0;  // m^2; corrected by n / (n - 1) for the mean taken from the same samples
  double rms_m() const;  // NaN without samples
  void add(const MultipathSum& other);
};

// Multipath of one signal.
struct MultipathOfSignal {
  std::array<MultipathSum, kElevationBins> bins;
  std::uint64_t arcs = 0;
  std::uint64_t short_arcs = 0, short_arc_samples = 0;  // left out
  MultipathSum all() const;
};

// MultipathLevels takes the mean of each arc from its samples. It uses the whole arc, because a
// moving mean would absorb slow multipath of a static antenna.
class MultipathLevels {
 public:
  using Signal = std::pair<SatelliteId, SignalCode>;
  // Arcs with fewer samples do not determine their mean and are left out.
  static constexpr std::uint64_t kMinSamples = 10;

  // Adds a sample; `arc` is not 0. Returns the index of the arc's mean.
  std::size_t add(const Signal& signal, std::uint64_t arc, double value_m, double elevation);
  // Ends all arcs.
  void finish();

  const std::map<Signal, MultipathOfSignal>& signals() const { return signals_; }
  // Returns the means by the index from add(); NaN for an arc left out. Precondition: finish().
  const std::vector<double>& means_m() const { return means_m_; }

 private:
  struct Moments {
    std::uint64_t samples = 0;
    double mean = 0.0, squares = 0.0;  // about the mean
  };
  struct Arc {
    std::uint64_t id = 0;
    std::size_t number = 0;
    std::array<Moments, kElevationBins> bins;
  };
  void close(const Signal& signal, const Arc& arc);

  std::map<Signal, Arc> open_;
  std::map<Signal, MultipathOfSignal> signals_;
  std::vector<double> means_m_;
};

}  // namespace leonav
