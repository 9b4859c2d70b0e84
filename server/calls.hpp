/// @file calls.hpp
/// What the server does, without HTTP: a request's text in, a status and a text out.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "limiter.hpp"
#include "robots.hpp"
#include "server.hpp"

namespace sinew::server {

struct Reply {
  int status = 200;
  std::string text;
  std::string_view type = "application/json";
};

/// `{"error": {"code", "where", "message"}}`, as of a query.
Reply refused(int status, std::string_view code, std::string_view where, std::string_view message);

class Calls {
 public:
  explicit Calls(const Options& options);

  Reply version() const;
  Reply robots() const;  ///< those that ship, and the one the page opens with
  Reply robot_text(const std::string& name) const;
  Reply open_robot(const std::string& text);
  Reply query(std::string_view handle, std::string_view body, const std::string& address);

  /// The robot of the command line: read before anything listens.
  std::optional<Errors> read_opened();

 private:
  std::string answers(Robot& robot, const std::vector<std::string_view>& queries, bool is_list);

  Options options_;
  std::string opened_text_;
  Robots robots_;
  Rate rate_;
  Places places_;
};

}  // namespace sinew::server
