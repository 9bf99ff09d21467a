// SigmaScale learns by how much errors are larger or smaller than their configured sigmas.
#pragma once
#include <array>
#include <span>

#include "core/filter/error_model/error_class.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// The scale s of a class is log-linear in its properties (multiplicative heteroskedasticity,
// Harvey, Econometrica 44(3), 1976):
//   log s = base(observable) + system + elevation + signal
// Each term follows the score of its own class, with innovations limited as in Huber's proposal 2
// (Huber and Ronchetti, Robust Statistics, 2009, 6.4): with z the standardized innovation and w the
// share of its variance that is the measurement's,
//   d term / dt = mean(w (min(z^2, k^2) - beta)) / (2 T),   beta = E[min(z^2, k^2)], z normal.
// Gross errors therefore count as k sigmas and no more. Terms beside the base return to zero, so
// that a class that is not seen is like all others.
class SigmaScale {
 public:
  // One standardized innovation.
  struct Sample {
    ErrorClass of;
    double squared_ratio = 0.0;   // z^2
    double measured_share = 0.0;  // w, 0 to 1
  };

  SigmaScale();
  void reset() { *this = SigmaScale(); }
  // Fits the observable's term and those of elevation to the first errors that are seen, so that
  // already these are weighed as large as they are. `squared_ratio` of `samples`: over the
  // configured variance. Without eight samples it does nothing and returns false.
  bool start(Observable observable, std::span<const Sample> samples);
  // Returns whether nothing has been seen of an observable.
  bool unseen(Observable observable) const {
    return terms_[static_cast<std::size_t>(observable)].base.age_s <= 0.0;
  }
  // Adds to the epoch under way.
  void add(const Sample& sample);
  // Ends the epoch: moves every term by what `interval_s` of its samples say.
  void end_epoch(double interval_s);
  // Returns s without regard to the class.
  double mean_scale(Observable observable) const;
  // Returns s of a class.
  double scale(const ErrorClass& of) const;

 private:
  struct Term {
    double value = 0.0;
    double score = 0.0;
    double age_s = 0.0;
    int count = 0;
  };
  struct Terms {  // of one observable
    Term base;
    std::array<Term, kSystemCount> system;
    std::array<Term, kElevationClasses> elevation;
    std::array<Term, kSignalClasses> signal;
  };
  std::array<Terms, kObservables> terms_;
};

}  // namespace leonav
