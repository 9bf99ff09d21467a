// The KeepRule decides when what is journaled is worth keeping, because it led up to a fault.
#pragma once
#include <cstdint>
#include <utility>

namespace leonav {

// Whether there is no answer, and why. What is wrong with the journal alone is no fault here.
enum class Fault : std::uint8_t {
  kNone,
  kSilence,     // an input that the answer needs does not come any more
  kNavigation,  // the inputs come
};

// That there is no answer yet is worth nothing. Inputs also fall silent where a vehicle is switched
// off and the service is stopped a little later; what led up to that is worth keeping only if the
// run goes on. Of a run that crashes, the journal keeps the end at the next start.
class KeepRule {
 public:
  // At each evaluation; true: the present piece and the one before it are to be kept.
  bool look(Fault fault) {
    const bool answered = std::exchange(answered_, fault == Fault::kNone);
    const bool was_silent = std::exchange(silent_, false);
    if (fault != Fault::kSilence) return was_silent || (answered && fault == Fault::kNavigation);
    silent_ = was_silent || answered;
    return false;
  }

 private:
  bool answered_ = false;  // at the last look
  bool silent_ = false;    // since there was an answer
};

}  // namespace leonav
