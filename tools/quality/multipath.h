// Code multipath and noise from code and carriers of two frequencies (L. H. Estey and C. M.
// Meertens, TEQC: The Multi-Purpose Toolkit for GPS/GLONASS Data, GPS Solutions 3(1), 1999, eq. 6
// and 7).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/gnss/observation.h"

namespace leonav {

// P_i - (1 + 2/(a-1)) L_i + 2/(a-1) L_j with a = f_i^2 / f_j^2, in metres: geometry, clocks,
// troposphere and the ionosphere's first order cancel; what is left is the multipath and noise of
// the code and a constant of the arc (ambiguities and delays). MP1 of the paper is that of i = 1, j
// = 2, MP2 that of i = 2, j = 1.
double multipath_combination_m(double code_m, double own_carrier_m, double other_carrier_m,
                               double own_hz, double other_hz);

// Bands of 10 degrees of elevation, and one for elevations not known.
inline constexpr std::size_t kElevationBins = 10;
inline constexpr std::size_t kNoElevation = 9;
std::size_t elevation_bin(double elevation);  // rad; NaN: kNoElevation; below 0: the lowest

// Sum over arcs of squares about each arc's mean.
struct MultipathSum {
  std::uint64_t samples = 0;
  double squares = 0.0;  // m^2, for the mean taken from as many samples: times n / (n - 1)
  double rms_m() const;  // NaN without samples
  void add(const MultipathSum& other);
};

struct MultipathOfSignal {
  std::array<MultipathSum, kElevationBins> bins;
  std::uint64_t arcs = 0;
  std::uint64_t short_arcs = 0, short_arc_samples = 0;  // left out
  MultipathSum all() const;
};

// Takes the mean of each arc from its samples. The whole arc's, since slow multipath of a standing
// antenna is multipath too, which a moving mean would take for the level.
class MultipathLevels {
 public:
  using Signal = std::pair<SatelliteId, SignalCode>;
  // Arcs with fewer samples say little of their own mean and are left out.
  static constexpr std::uint64_t kMinSamples = 10;

  // `arc`: not 0. Returns the number under which the arc's mean will be known.
  std::size_t add(const Signal& signal, std::uint64_t arc, double value_m, double elevation);
  // Ends all arcs.
  void finish();

  const std::map<Signal, MultipathOfSignal>& signals() const { return signals_; }
  // By the number that add() returned; NaN for an arc left out. After finish().
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
