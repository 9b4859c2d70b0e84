#include "robots.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <utility>

#include "sinew/io/parse.hpp"

namespace sinew::server {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string handle_of(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Where the text stands that begins at `at` in quotes; past its end if it does not close.
std::size_t end_of_quotes(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at;
}

}  // namespace

Robot::Robot(Document document, Session first) : document_(std::move(document)) {
  idle_.push_back(std::move(first));
}

Expected<Session> Robot::take() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      Session session = std::move(idle_.back());
      idle_.pop_back();
      return session;
    }
  }
  return Session::open(document_);
}

void Robot::give_back(Session session) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(session));
}

Expected<std::string> Robots::open(const std::string& text) {
  std::string handle = handle_of(text);
  if (find(handle)) return handle;
  auto document = parse_yaml(text, "robot");
  if (!document) return tl::unexpected(document.error());
  auto session = Session::open(*document);
  if (!session) return tl::unexpected(session.error());
  auto robot = std::make_shared<Robot>(std::move(*document), std::move(*session));
  const std::lock_guard lock(mutex_);
  entries_.push_front({handle, std::move(robot)});
  if (entries_.size() > most_) entries_.pop_back();
  return handle;
}

std::shared_ptr<Robot> Robots::find(std::string_view handle) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(entries_, [&](const Entry& entry) { return entry.handle == handle; });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->robot;
}

std::vector<std::string_view> queries_of(std::string_view body) {
  body = trimmed(body);
  if (body.starts_with('{')) return {body};
  if (!body.starts_with('[') || !body.ends_with(']') || body.size() < 2) return {};
  body = body.substr(1, body.size() - 2);
  std::vector<std::string_view> queries;
  std::size_t begin = 0, depth = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const char c = body[i];
    if (c == '"') i = end_of_quotes(body, i);
    if (i >= body.size()) return {};
    if (c == '{' || c == '[') ++depth;
    if ((c == '}' || c == ']') && depth-- == 0) return {};
    if (c == ',' && depth == 0) {
      queries.push_back(trimmed(body.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  if (depth != 0) return {};
  const std::string_view last = trimmed(body.substr(begin));
  if (!last.empty() || !queries.empty()) queries.push_back(last);
  return queries;
}

}  // namespace sinew::server
