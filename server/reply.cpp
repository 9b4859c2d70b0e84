#include "reply.hpp"

#include <nlohmann/json.hpp>

namespace sinew::server {

std::string error_text(std::string_view code, std::string_view where, std::string_view message) {
  using Json = nlohmann::ordered_json;
  const Json json{{"error", {{"code", code}, {"where", where}, {"message", message}}}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Reply refused(int status, std::string_view code, std::string_view where, std::string_view message) {
  return {status, error_text(code, where, message)};
}

}  // namespace sinew::server
