// The OutputQueue holds what one reader has not taken yet, up to a limit.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

namespace leonav {

// All sentences of one instant; every reader shares it.
struct Batch {
  std::string text;
  int sentences = 0;
};

// A batch that finds no room is lost as a whole, so that no reader gets half a sentence. The next
// one that finds room comes behind a TXT sentence with how many were lost.
class OutputQueue {
 public:
  // At 1 Hz a quarter of a minute: older positions are of no use to anyone.
  static constexpr std::size_t kMostBytes = 16'384;

  // Returns false where the batch is lost.
  bool offer(const std::shared_ptr<const Batch>& batch);

  bool is_empty() const { return texts_.empty(); }
  // What goes out next. Precondition: not empty.
  const char* data() const { return texts_.front()->data() + offset_; }
  std::size_t size() const { return texts_.front()->size() - offset_; }
  void consume(std::size_t bytes);
  // Forgets what waits, without counting it as lost: nobody reads.
  void clear();

  std::uint64_t lost_sentences() const { return lost_; }

 private:
  void push(std::shared_ptr<const std::string> text);

  std::deque<std::shared_ptr<const std::string>> texts_;
  std::size_t bytes_ = 0, offset_ = 0;
  std::uint64_t lost_ = 0, untold_ = 0;
};

}  // namespace leonav
