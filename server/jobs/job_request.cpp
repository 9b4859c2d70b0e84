#include "job_request.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "server/queries.hpp"

namespace sinew::server {
namespace {

constexpr std::string_view form = R"(give {"study": NAME}, or {"robot": HANDLE, "queries": [{...}, ...]})";

/// `"name": value` apart; the value is empty where it is none.
std::pair<std::string_view, std::string_view> member_of(std::string_view text) {
  if (!text.starts_with('"')) return {};
  const std::size_t end = end_of_quotes(text, 0);
  if (end >= text.size()) return {};
  const std::string_view rest = trimmed(text.substr(end + 1));
  if (!rest.starts_with(':')) return {};
  return {text.substr(1, end - 1), trimmed(rest.substr(1))};
}

Expected<std::string> text_of(std::string_view name, std::string_view value) {
  // Only a text is parsed: of brackets within brackets a tree would take a thousand times their size.
  const auto json = value.starts_with('"') ? nlohmann::json::parse(value, nullptr, false) : nlohmann::json();
  if (json.is_string() && !json.get_ref<const std::string&>().empty()) return json.get<std::string>();
  return failure("wrong_type", name, fmt::format("{} is a text that is not empty", name));
}

Expected<void> read_member(std::string_view name, std::string_view value, std::size_t most,
                           JobRequest& request) {
  if (name == "queries") {
    request.queries = value.starts_with('[') ? queries_of(value, most) : std::vector<std::string_view>();
    if (request.queries.empty())
      return failure("wrong_type", name, "queries is an array of queries, [{...}, ...], and not empty");
    return {};
  }
  if (name != "study" && name != "robot") return failure("unknown_field", name, form);
  auto text = text_of(name, value);
  if (!text) return tl::unexpected(text.error());
  (name == "study" ? request.study : request.robot) = std::move(*text);
  return {};
}

}  // namespace

Expected<JobRequest> read_job(std::string_view body, std::size_t most) {
  body = trimmed(body);
  if (!body.starts_with('{') || !body.ends_with('}') || body.size() < 2)
    return failure("json_syntax", "body", form);
  const std::string_view inside = trimmed(body.substr(1, body.size() - 2));
  const std::vector<std::string_view> elements = elements_of(inside, 3);
  if (elements.empty() && !inside.empty()) return failure("json_syntax", "body", form);
  JobRequest request;
  for (const std::string_view element : elements) {
    const auto [name, value] = member_of(element);
    if (value.empty()) return failure("json_syntax", "body", form);
    if (const auto read = read_member(name, value, most, request); !read) return tl::unexpected(read.error());
  }
  const bool is_study = !request.study.empty() && request.robot.empty() && request.queries.empty(),
             is_list = request.study.empty() && !request.robot.empty() && !request.queries.empty();
  if (!is_study && !is_list) return failure("missing_field", "body", form);
  return request;
}

}  // namespace sinew::server
