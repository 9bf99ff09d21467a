// This function prints the tables of docs/operations/events.md.
#pragma once
#include <string>

namespace leonav {

// In Markdown: the kinds of events, the faults of rejected_input, the causes of filter_reset, with
// an empty line between them.
std::string events_as_markdown();

}  // namespace leonav
