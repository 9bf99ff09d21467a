// These functions convert risks and fault rates per hour to probabilities at one independent
// sample.
//
// An error that is correlated over a time tau takes 3600 s / tau independent values in an hour.
// Each of them may exceed its level, so that the risk of an hour is shared among them: the "number
// of effective samples" of Milner, Pervan, Blanch, Joerger, "Evaluating Integrity and Continuity
// Over Time in Advanced RAIM", IEEE/ION PLANS 2020.
#pragma once

namespace leonav {

// Returns the number of independent samples in an hour, at least 1. `correlation_s` is positive.
double samples_per_hour(double correlation_s);

// Returns the risk that one sample may use of `risk_per_hour`.
double risk_per_sample(double risk_per_hour, double correlation_s);

// Returns the probability that a fault is present at one sample without having been detected.
// Faults of rate `rate_per_hour` stay for `exposure_s`, the time until they end or are detected. A
// fault spoils at least one sample, however soon it ends. At most 1.
double fault_probability(double rate_per_hour, double exposure_s, double correlation_s);

}  // namespace leonav
