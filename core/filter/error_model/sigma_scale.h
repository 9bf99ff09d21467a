// SigmaScale learns by how much errors are larger than their configured sigmas.
#pragma once
#include <array>
#include <span>

#include "core/filter/error_model/error_class.h"
#include "core/filter/error_model/learned_summary.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// The scale s of a class is log-linear in its properties (multiplicative heteroskedasticity,
// Harvey, Econometrica 44(3), 1976):
//   log s = base(observable) + system + elevation + signal + loss
// Each term follows the score of its own class, with innovations limited as in Huber's proposal 2
// (Huber and Ronchetti, Robust Statistics, 2009, 6.4): with z the standardized innovation and w the
// share of its variance that is the measurement's,
//   d term / dt = mean(w (min(z^2, k^2) - beta)) / (2 T),   beta = E[min(z^2, k^2)], z normal.
// Gross errors therefore count as k sigmas and no more. Terms beside the base return to zero, so
// that a class that is not seen is like all others. s is never below one, and smaller errors of a
// class that has s = 1 move no term.
class SigmaScale {
 public:
  // One standardized innovation.
  struct Sample {
    ErrorClass of;
    double squared_ratio = 0.0;   // z^2
    double measured_share = 0.0;  // w, 0 to 1
  };

  SigmaScale();
  // Takes a scale as that of an observable, until errors are seen: by `share` of its logarithm, the
  // rest is what is expected without it.
  void start(Observable observable, double scale, double share);
  void reset() { *this = SigmaScale(); }
  // Fits the observable's term and those of elevation to the errors of a first epoch;
  // `squared_ratio` of `samples` is taken over the configured variance. With fewer than eight
  // samples it does nothing and returns false.
  bool fit_first(Observable observable, std::span<const Sample> samples);
  // Adds to the epoch under way.
  void add(const Sample& sample);
  // Ends the epoch: moves every term by what `interval_s` of its samples say.
  void end_epoch(double interval_s);
  // Returns s without regard to the class.
  double mean_scale(Observable observable) const;
  // Returns s of a class.
  double scale(const ErrorClass& of) const;
  // Writes the factors of one observable: its mean, and what each property alone makes of it.
  void summarize(Observable observable, ObservableErrors* summary) const;

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
    std::array<Term, kLossClasses> loss;
  };
  // Sum of the terms of a class: log s where that is not below zero.
  double sum_of_terms(const ErrorClass& of) const;
  // min(z^2, k^2) - beta; at s = 1 not below zero.
  double score(const ErrorClass& of, double squared_ratio) const;

  std::array<Terms, kObservables> terms_;
};

}  // namespace leonav
