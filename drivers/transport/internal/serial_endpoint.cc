#include "drivers/transport/internal/serial_endpoint.h"

#include <sys/ioctl.h>
#include <termios.h>

#include <boost/asio/post.hpp>
#include <utility>

namespace leonav {

namespace asio = boost::asio;
using boost::system::error_code;

void SerialEndpoint::open(Opened opened) {
  error_code error;
  port_.open(options_.device, error);
  if (!error) error = configure();
  if (error) close();
  asio::post(port_.get_executor(), [opened = std::move(opened), error] { opened(error); });
}

error_code SerialEndpoint::configure() {
  using Base = asio::serial_port_base;
  // From here on another program's attempt to open the port fails, instead of taking half of the
  // bytes.
  ioctl(port_.native_handle(), TIOCEXCL);
  error_code error;
  const auto set = [&](auto option) {
    if (!error) port_.set_option(option, error);
  };
  set(Base::baud_rate(options_.baud));
  set(Base::character_size(8));
  set(Base::parity(Base::parity::none));
  set(Base::stop_bits(Base::stop_bits::one));
  set(Base::flow_control(Base::flow_control::none));
  // What came before the rate was set is not worth reading.
  if (!error) tcflush(port_.native_handle(), TCIFLUSH);
  return error;
}

void SerialEndpoint::read(asio::mutable_buffer buffer, Read done) {
  port_.async_read_some(buffer, std::move(done));
}

void SerialEndpoint::close() {
  error_code ignored;
  port_.close(ignored);
}

std::string SerialEndpoint::text_of(const error_code& error) const {
  namespace errc = boost::system::errc;
  const std::string what = options_.device + ": ";
  if (error == errc::no_such_file_or_directory || error == errc::no_such_device ||
      error == errc::no_such_device_or_address) {
    return what +
           "there is no such device; is it plugged in? ls -l /dev/serial/by-id lists those "
           "that are";
  }
  if (error == errc::permission_denied) {
    return what + "may not be opened; put the user into the group that owns the device (dialout)";
  }
  if (error == errc::device_or_resource_busy) {
    return what + "another program holds it; fuser -v " + options_.device + " names it";
  }
  if (error == errc::invalid_argument) {
    return what + "does not take " + std::to_string(options_.baud) +
           " baud; use a rate that port and sensor have, such as 115200, 230400, 460800, 921600";
  }
  if (error == errc::inappropriate_io_control_operation) {
    return what +
           "is no serial port; name a device such as /dev/ttyACM0, or read a file with 'source: "
           "file', a pipe with 'source: stdin'";
  }
  if (error == errc::io_error || error == asio::error::eof) {
    return what + "is gone; was the sensor unplugged or switched off?";
  }
  return what + error.message();
}

}  // namespace leonav
