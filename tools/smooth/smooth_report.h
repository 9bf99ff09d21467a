// This unit says in words how a whole log was smoothed, and what is known of the installation.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "core/smoother/batch/batch_smoother.h"

namespace leonav {

// Prints "key: value" lines: size, iterations, residuals by observable, sigmas, constants.
void print_smoothed(const LogGraph& graph, const BatchResult& result, std::ostream& out);

// Returns what a user should know before relying on the result; empty: nothing.
std::vector<std::string> smoothing_warnings(const LogGraph& graph, const BatchResult& result);

}  // namespace leonav
