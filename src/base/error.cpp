#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

const char* version() noexcept { return SINEW_VERSION_STRING; }

std::string to_string(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    if (!text.empty()) text += '\n';
    text += error.where + ": " + error.message + " [" + error.code + "]";
  }
  return text;
}

}  // namespace sinew::inline v1
