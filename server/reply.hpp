/// @file reply.hpp
/// What a request is answered, before it is HTTP.
#pragma once
#include <memory>
#include <string>
#include <string_view>

namespace sinew::server {

struct Reply {
  int status = 200;
  std::string text;
  std::string_view type = "application/json";
  std::shared_ptr<const std::string> kept = {};  ///< in the text's place: as large as a result may be
};

/// `{"error": {"code", "where", "message"}}`, as of a query.
std::string error_text(std::string_view code, std::string_view where, std::string_view message);

/// A request that cannot be answered: its reason as `error_text`.
Reply refused(int status, std::string_view code, std::string_view where, std::string_view message);

}  // namespace sinew::server
