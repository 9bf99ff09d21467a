#include "drivers/transport/internal/name_lookup.h"

#include <boost/asio/error.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using asio::ip::tcp;

struct NameLookup::State {
  std::mutex mutex;
  asio::io_context* io = nullptr;  // null: nobody is there any more
  bool is_asking = false;
  Found found;  // of the io_context's thread alone
};

NameLookup::Results NameLookup::ask_system(const std::string& host, const std::string& port,
                                           Error* error) {
  asio::io_context own;
  return tcp::resolver(own).resolve(host, port, *error);
}

NameLookup::NameLookup(asio::io_context* io, const std::string& host, std::uint16_t port,
                       Query query)
    : io_(io),
      host_(host),
      port_(port),
      query_(std::move(query)),
      state_(std::make_shared<State>()) {
  state_->io = io;
}

NameLookup::~NameLookup() {
  cancel();
  const std::lock_guard lock(state_->mutex);
  state_->io = nullptr;
}

void NameLookup::start(Found found) {
  state_->found = std::move(found);
  Error error;
  const asio::ip::address address = asio::ip::make_address(host_, error);
  if (error) return ask();
  answer({}, Results::create(tcp::endpoint(address, port_), host_, std::to_string(port_)));
}

void NameLookup::cancel() { state_->found = nullptr; }

bool NameLookup::is_asking() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_asking;
}

// An answer that comes when nobody waits any more finds nobody; all answers are to the same
// question.
void NameLookup::answer(const Error& error, const Results& results) {
  asio::post(*io_, [state = state_, error, results] {
    if (const Found found = std::exchange(state->found, nullptr)) found(error, results);
  });
}

void NameLookup::ask() {
  const std::lock_guard lock(state_->mutex);
  if (state_->is_asking) return;
  try {
    std::thread([state = state_, query = query_, host = host_, port = std::to_string(port_)] {
      Error error;
      const Results results = query(host, port, &error);
      const std::lock_guard answered(state->mutex);
      state->is_asking = false;
      if (state->io == nullptr) return;
      asio::post(*state->io, [state, error, results] {
        if (const Found found = std::exchange(state->found, nullptr)) found(error, results);
      });
    }).detach();
    state_->is_asking = true;
  } catch (const std::system_error&) {
    answer(asio::error::no_memory, {});
  }
}

}  // namespace leonav
