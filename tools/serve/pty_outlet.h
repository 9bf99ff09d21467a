// The PtyOutlet makes a pseudo-terminal, which other programs open as if a receiver were on it.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>

#include "tools/serve/outlet.h"
#include "tools/serve/stream_writer.h"

namespace leonav {

// Nothing is written while nobody has the terminal open, so that a reader begins with fresh
// sentences.
class PtyOutlet final : public Outlet {
 public:
  // Makes the terminal and the symbolic link `link` to it. A link to a pseudo-terminal that is
  // there is replaced, any other link or file is not. Throws FileError.
  PtyOutlet(boost::asio::io_context* io, const std::string& link);
  ~PtyOutlet() override;

  void send(const std::shared_ptr<const Batch>& batch) override;
  std::string status() const override;

 private:
  using Terminal = StreamWriter<boost::asio::posix::stream_descriptor>;
  bool has_reader();

  std::string link_, device_;
  std::shared_ptr<Terminal> terminal_;
  bool was_read_ = false;
};

}  // namespace leonav
