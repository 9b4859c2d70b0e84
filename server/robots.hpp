/// @file robots.hpp
/// Robots that pages have opened, under handles: a handle is a hash of the text, so the same file has the
/// same one, and a page that comes back after a restart of the server puts its text again and goes on.
#pragma once
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/session.hpp"

namespace sinew::server {

/// The same for the same text.
std::string handle_of(std::string_view text);

/// The robot of a file, or one that ships, as settings by their paths change it.
Expected<Document> changed_robot(const std::string& robot, std::span<const Member> settings);
/// The same as the text of a file; without settings that of the file itself.
Expected<std::string> changed_text(const std::string& robot, std::span<const Member> settings);
/// As a command line has it, `legs[0].link.length=180 mm`.
std::string setting_text(const Member& setting);

/// One text, and sessions of it that nobody uses at the moment.
class OpenRobot {
 public:
  OpenRobot(Document document, Session first);

  /// A session for this thread until it is given back, as when it was opened: `"start": "last"` is of the
  /// same request or job.
  Expected<Session> take();
  void give_back(Session session);

 private:
  Document document_;
  std::mutex mutex_;
  std::vector<Session> idle_;
};

/// An answer of the session; an exception is told in its place.
std::string answer_of(Session& session, std::string_view query);

/// For any number of threads.
class Robots {
 public:
  /// @param max_bytes of the texts of all that are kept; the last one is in any case
  Robots(std::size_t most, std::size_t max_bytes) : most_(most), max_bytes_(max_bytes) {}

  /// The handle of a robot file's text, or all its errors; their places are `robot:LINE:COLUMN`.
  Expected<std::string> open(const std::string& text);
  /// Null where there is none (any more).
  std::shared_ptr<OpenRobot> find(std::string_view handle);

 private:
  struct Entry {
    std::string handle;
    std::size_t bytes;  // of its text
    std::shared_ptr<OpenRobot> robot;
  };

  std::size_t most_, max_bytes_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // the last used first
  std::size_t bytes_ = 0;     // of their texts
};

}  // namespace sinew::server
