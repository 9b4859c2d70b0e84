/// @file port.hpp
/// Bytes to and from a controller, and the serial port that carries them.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"

namespace sinew::server::device {

/// Neither way waits.
class Wire {
 public:
  virtual ~Wire() = default;
  /// All that has come.
  virtual std::string read() = 0;
  virtual void write(std::string_view bytes) = 0;
  /// It was unplugged: nothing comes any more, it has to be opened anew.
  virtual bool is_gone() const = 0;
  /// Waits until bytes come, but no longer than that [s].
  virtual void wait(double seconds) = 0;
};

/// A serial port or a pseudo-terminal: raw, 8N1, at any baud rate that it can.
/// Errors: `no_device`, and `in_use` where another program has it.
Expected<std::unique_ptr<Wire>> open_port(const std::string& path, int baud);

}  // namespace sinew::server::device
