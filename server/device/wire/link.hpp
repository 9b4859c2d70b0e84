/// @file link.hpp
/// Requests to a controller and its replies: one under way at a time, with sequence numbers, checksums, time
/// limits, and a new hello whenever something was lost.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frames.hpp"
#include "port.hpp"

namespace sinew::server::device {

/// Something that happened on the line.
struct LinkEvent {
  enum class Kind {
    answer,   ///< to the last request; `error` where it was refused
    damaged,  ///< a line failed its checksum, or a request did
    lost,     ///< no answer came in time
    gone,     ///< unplugged
    found     ///< a controller says hello: after a start, after a reset, plugged in again
  };
  Kind kind;
  char verb = 0;  ///< of the request
  DriveMode mode = DriveMode::disarmed;
  WireError error = WireError::none;
  std::string payload = {};
  bool is_same_session = false;  ///< of `found`: it was only the line that was away
};

struct LinkFigures {
  double heard = -1e9;    ///< when the last whole reply came [s]
  double round_trip = 0;  ///< [s]
  long lines = 0, errors = 0;
  long damaged_line = 0;  ///< number of the last damaged one, 0: none
  bool is_gone = true;
};

/// What a panel needs of a line; tests have their own.
class Link {
 public:
  virtual ~Link() = default;
  /// What has happened since the last call. It also opens the line, says hello, and gives up waiting.
  virtual std::vector<LinkEvent> poll(double now) = 0;
  /// Whether a request may go out.
  virtual bool is_free() const = 0;
  virtual void ask(char verb, std::string_view payload, double now) = 0;
  /// Null until there was one; kept while the line is lost.
  virtual const Hello* hello() const = 0;
  virtual const LinkFigures& figures() const = 0;
};

class ControllerLink : public Link {
 public:
  /// Null where the port cannot be opened (yet).
  using Open = std::function<std::unique_ptr<Wire>()>;

  explicit ControllerLink(Open open) : open_(std::move(open)) {}

  std::vector<LinkEvent> poll(double now) override;
  bool is_free() const override { return wire_ && !asked_ && !needs_hello_; }
  void ask(char verb, std::string_view payload, double now) override;
  const Hello* hello() const override { return hello_ ? &*hello_ : nullptr; }
  const LinkFigures& figures() const override { return figures_; }
  /// Until bytes come, or so long [s].
  void wait(double seconds);

 private:
  struct Asked {
    char verb;
    std::uint32_t sequence;
    double time;
  };
  void open(double now);
  void say_hello(double now);
  void hear(std::string_view line, double now, std::vector<LinkEvent>& events);
  void take(const RawReply& reply, double now, std::vector<LinkEvent>& events);
  void take_hello(const RawReply& reply, std::vector<LinkEvent>& events);
  void damage(std::vector<LinkEvent>& events);

  Open open_;
  std::unique_ptr<Wire> wire_;
  std::optional<Hello> hello_;
  std::optional<Asked> asked_;
  std::string line_;
  LinkFigures figures_;
  std::uint32_t sequence_ = 0;
  double next_open_ = -1e9, next_hello_ = -1e9;
  bool needs_hello_ = true, is_new_ = true;
};

}  // namespace sinew::server::device
