#include "robots.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "io/document/parse.hpp"
#include "io/document/yaml_text.hpp"
#include "reply.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::server {

std::string handle_of(std::string_view text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string setting_text(const Member& setting) {
  const Node& value = setting.value;
  return setting.key + '=' + (value.kind == Node::Kind::string ? value.text : yaml_line(value));
}

Expected<Document> changed_robot(const std::string& robot, std::span<const Member> settings) {
  return read_robot_file(robot).and_then([&](const Document& document) { return with(document, settings); });
}

Expected<std::string> changed_text(const std::string& robot, std::span<const Member> settings) {
  if (settings.empty()) return read_robot_text(robot);
  return changed_robot(robot, settings).map([&](const Document& document) {
    std::string text = fmt::format("# {}, changed by --set\n", one_line(robot, 200));
    for (const Member& setting : settings)
      text += fmt::format("#   {}\n", one_line(setting_text(setting), 200));
    return text + yaml_text(document.root);
  });
}

OpenRobot::OpenRobot(Document document, Session first) : document_(std::move(document)) {
  idle_.push_back(std::move(first));
}

Expected<Session> OpenRobot::take() {
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

void OpenRobot::give_back(Session session) {
  session.forget();
  session.stop_on({});
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(session));
}

std::string answer_of(Session& session, std::string_view query) {
  try {
    return session.answer(query);
  } catch (const std::exception& error) {
    return error_text("internal", "query", fmt::format("this query failed inside sinew: {}", error.what()));
  }
}

Expected<std::string> Robots::open(const std::string& text) {
  std::string handle = handle_of(text);
  if (find(handle)) return handle;
  auto document = parse_yaml(text, "robot");
  if (!document) return tl::unexpected(document.error());
  auto session = Session::open(*document);
  if (!session) return tl::unexpected(session.error());
  auto robot = std::make_shared<OpenRobot>(std::move(*document), std::move(*session));
  const std::lock_guard lock(mutex_);
  const bool has_come = std::ranges::find(entries_, handle, &Entry::handle) != entries_.end();  // meanwhile
  if (has_come) return handle;
  entries_.push_front({handle, text.size(), std::move(robot)});
  bytes_ += text.size();
  while (entries_.size() > 1 && (entries_.size() > most_ || bytes_ > max_bytes_)) {
    bytes_ -= entries_.back().bytes;
    entries_.pop_back();
  }
  return handle;
}

std::shared_ptr<OpenRobot> Robots::find(std::string_view handle) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(entries_, [&](const Entry& entry) { return entry.handle == handle; });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->robot;
}

}  // namespace sinew::server
