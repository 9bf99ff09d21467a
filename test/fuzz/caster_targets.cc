// What an NTRIP caster answers.
#include "support/ntrip_answers.h"
#include "test/fuzz/byte_script.h"
#include "test/fuzz/target_groups.h"

namespace leonav::test {
namespace {

// The first byte is the length of the pieces. The stream must not depend on it.
void run_answer(FuzzBytes bytes) {
  ByteScript script(bytes);
  const std::size_t piece = 1U + script.byte();
  const FuzzBytes answer = script.rest();
  const ReadAnswer in_pieces = read_answer(answer, piece);
  const ReadAnswer at_once = read_answer(answer, answer.size() + 1);
  if (in_pieces.stream.size() > answer.size()) throw Finding("a stream longer than the answer");
  if (in_pieces.answer != at_once.answer || in_pieces.status != at_once.status ||
      in_pieces.stream != at_once.stream) {
    throw Finding("an answer in pieces of " + std::to_string(piece) + " bytes is another one");
  }
}

}  // namespace

std::vector<FuzzTarget> caster_targets() { return {{"caster", run_answer}}; }

}  // namespace leonav::test
