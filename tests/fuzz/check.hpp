/// @file check.hpp
/// What holds of every error and answer, whatever was asked. Where it does not, the target dies.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/document/parse.hpp"
#include "sinew/base/error.hpp"

namespace sinew::fuzz {

[[noreturn]] inline void die(std::string_view why, std::string_view found) {
  std::fprintf(stderr, "%.*s: %.*s\n", static_cast<int>(why.size()), why.data(),
               static_cast<int>(std::min<std::size_t>(found.size(), 2000)), found.data());
  std::abort();
}

inline void check_errors(const Errors& errors) {
  if (errors.empty()) die("an Expected without a value and without errors", "");
  for (const Error& error : errors) {
    if (error.code.empty() || error.where.empty() || error.message.empty())
      die("an error that does not say what, where and why", to_string(errors));
    if (error.message.find('\n') != std::string::npos) die("an error of two lines", error.message);
    if (utf8_size(error.message) != error.message.size()) die("an error that is no text", error.message);
  }
}

/// A NaN or an infinity is written as null.
inline bool has_null(const nlohmann::json& json) {
  return json.is_null() ||
         (json.is_structured() &&
          std::any_of(json.begin(), json.end(), [](const auto& part) { return has_null(part); }));
}

/// One answer of a session.
inline void check_answer(const std::string& text) {
  const auto answer = nlohmann::json::parse(text, nullptr, false);
  if (!answer.is_object()) die("an answer that is no JSON", text);
  if (has_null(answer)) die("an answer with a null: a NaN or an infinity", text);
  if (answer.contains("error")) {
    for (const char* key : {"code", "where", "message"})
      if (!answer["error"].contains(key) || answer["error"][key].get<std::string>().empty())
        die("an error that does not say what, where and why", text);
    return;
  }
  if (!answer.contains("status") || !answer.contains("query") || !answer.contains("robot"))
    die("an answer without status", text);
  const bool explains = answer.contains("message") && !answer["message"].get<std::string>().empty();
  const auto status = answer["status"].get<std::string>();
  if (status != "converged" && status != "unstable" && !explains)
    die("a solve that failed and does not say why", text);
}

}  // namespace sinew::fuzz
