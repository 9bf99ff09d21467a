#include "drivers/yaml/one_document.h"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

namespace leonav {
namespace {

constexpr std::size_t kMostBytes = 1'000'000;

// Notes where a document begins, and leaves it.
class DocumentStart final : public YAML::EventHandler {
 public:
  const YAML::Mark& mark() const { return mark_; }

  void OnDocumentStart(const YAML::Mark& mark) override { mark_ = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  YAML::Mark mark_ = YAML::Mark::null_mark();
};

}  // namespace

YAML::Node load_one_document(const std::string& text) {
  if (text.size() > kMostBytes)
    throw YAML::ParserException(YAML::Mark(), "is longer than a megabyte, which no settings are");
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStart first, second;
  if (!parser.HandleNextDocument(first)) return {};
  if (parser.HandleNextDocument(second)) {
    const bool stands_still = second.mark().pos == first.mark().pos;
    throw YAML::ParserException(second.mark(), stands_still
                                                   ? "a key is expected here"
                                                   : "a second document begins here ('---'), which "
                                                     "would not be read; keep one");
  }
  return YAML::Load(text);
}

}  // namespace leonav
