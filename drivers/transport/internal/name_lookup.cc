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
  // Of the io_context's thread alone:
  Found found;
  std::uint64_t attempt = 0;
};

NameLookup::NameLookup(asio::io_context* io, const std::string& host, std::uint16_t port)
    : io_(io), host_(host), port_(port), state_(std::make_shared<State>()) {
  state_->io = io;
}

NameLookup::~NameLookup() {
  cancel();
  const std::lock_guard lock(state_->mutex);
  state_->io = nullptr;
}

void NameLookup::start(Found found) {
  ++state_->attempt;
  state_->found = std::move(found);
  Error error;
  const asio::ip::address address = asio::ip::make_address(host_, error);
  if (error) return ask();
  answer({}, Results::create(tcp::endpoint(address, port_), host_, std::to_string(port_)));
}

void NameLookup::cancel() {
  ++state_->attempt;
  state_->found = nullptr;
}

bool NameLookup::is_asking() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_asking;
}

// Of this attempt alone.
void NameLookup::answer(const Error& error, const Results& results) {
  asio::post(*io_, [state = state_, attempt = state_->attempt, error, results] {
    if (attempt != state->attempt) return;
    if (const Found found = std::exchange(state->found, nullptr)) found(error, results);
  });
}

void NameLookup::ask() {
  const std::lock_guard lock(state_->mutex);
  if (state_->is_asking) return;
  try {
    std::thread([state = state_, host = host_, port = std::to_string(port_)] {
      asio::io_context own;
      tcp::resolver resolver(own);
      Error error;
      const Results results = resolver.resolve(host, port, error);
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
