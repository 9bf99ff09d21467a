// What an NTRIP caster answers.
#include "support/programs/ntrip_answers.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

// The first byte is the length of the pieces. What is taken for an answer, and its stream, must not
// depend on it. An answer that is none may stay pending in pieces: the parser of HTTP finds some
// errors only when the next piece comes.
void run_answer(FuzzBytes bytes) {
  ByteScript script(bytes);
  const std::size_t piece = 1U + script.byte();
  const FuzzBytes answer = script.rest();
  const ReadAnswer in_pieces = read_answer(answer, piece);
  const ReadAnswer at_once = read_answer(answer, answer.size() + 1);
  if (in_pieces.stream.size() > answer.size()) throw Finding("a stream longer than the answer");
  const bool pending =
      in_pieces.answer == NtripAnswer::kPending && at_once.answer == NtripAnswer::kNotNtrip;
  if (pending && in_pieces.stream.empty() && at_once.stream.empty()) return;
  if (in_pieces.answer != at_once.answer || in_pieces.status != at_once.status ||
      in_pieces.stream != at_once.stream) {
    throw Finding("an answer in pieces of " + std::to_string(piece) + " bytes is another one");
  }
}

}  // namespace

std::vector<FuzzTarget> caster_targets() { return {{"caster", run_answer}}; }

}  // namespace leonav::test
