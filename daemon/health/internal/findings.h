// Findings are the reasons that one monitor of HEALTH has found at one look.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/health/health_reason.h"

namespace leonav {

// What is reserved for the detail of a reason, so that a usual one takes no memory.
inline constexpr std::size_t kDetailBytes = 256;

struct Finding {
  HealthReason reason{};
  std::string detail;  // as ActiveReasons::raise() takes it
};

// Memory is taken at construction, and again only where a look finds more, or a longer detail,
// than any before.
class Findings {
 public:
  Findings();

  void clear() { used_ = 0; }
  void add(HealthReason reason, std::string_view detail = {});
  // Valid until the next call.
  std::span<const Finding> get() const { return {findings_.data(), used_}; }

 private:
  std::vector<Finding> findings_;
  std::size_t used_ = 0;
};

// Adds a text to a list with commas.
void append_to_list(std::string_view text, std::string* list);

}  // namespace leonav
