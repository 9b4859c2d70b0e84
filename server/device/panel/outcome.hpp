/// @file outcome.hpp
/// What becomes of a command.
#pragma once
#include <optional>
#include <string>

namespace sinew::server::device {

/// A command that is not obeyed: a stable code, and the way out in words.
struct Refused {
  std::string code, message;
};
using Outcome = std::optional<Refused>;  ///< nothing: it is done, or begun

}  // namespace sinew::server::device
