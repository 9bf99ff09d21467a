// A CommandSender sends a command to leonavd and waits for the answer.
#pragma once
#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <string>

#include "core/navigator/interface/event.h"
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/interface/stage_work.h"
#include "daemon/commands/command_key.h"
#include "drivers/lcm/signed_command.h"

namespace leonav {

class CommandSender {
 public:
  // `key`: the command is signed with it. Throws LcmError.
  CommandSender(const std::string& url, const std::string& prefix, std::optional<CommandKey> key);

  // Sends the command under a number of its own, and returns the answer. Throws std::runtime_error
  // with a remedy where none comes within `timeout_s`. It does not try again: where only the answer
  // was lost, the command would be done twice.
  CommandResult send(const Command& command, double timeout_s);

 private:
  void wait_for_nonce(double timeout_s);
  void publish(const Command& command);
  std::string why_no_answer() const;
  void on_nonce(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void on_event(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void handle_until(std::int64_t until_ns);

  std::string url_, prefix_;
  std::optional<CommandKey> key_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::optional<CommandNonce> nonce_;  // the last one that came
  std::uint64_t sequence_ = 0;         // of the command
  std::optional<CommandResult> result_;
  std::optional<InputFault> rejected_;  // of any input since the command
};

}  // namespace leonav
