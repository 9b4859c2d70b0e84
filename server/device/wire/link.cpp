#include "link.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "server/device/times.hpp"

namespace sinew::server::device {
namespace {

constexpr double reopen_after = 0.5;  // [s]
constexpr double hello_after = 0.25;  // [s]; a board that resets when it is opened answers later
constexpr double smoothing = 0.1;     // of the round trip that is shown
constexpr std::size_t longest_line = 4096;

}  // namespace

void ControllerLink::wait(double seconds) {
  if (wire_)
    wire_->wait(seconds);
  else
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void ControllerLink::open(double now) {
  if (now < next_open_) return;
  next_open_ = now + reopen_after;
  wire_ = open_();
  if (!wire_) return;
  figures_.is_gone = false;
  line_.clear();
  asked_.reset();
  needs_hello_ = is_new_ = true;
  next_hello_ = now;
  wire_->write("\n");  // ends what an earlier host may have left unfinished; it is answered as truncated
}

void ControllerLink::say_hello(double now) {
  next_hello_ = now + hello_after;
  asked_ = Asked{'H', 0, now};
  wire_->write(encode('H', 0, 0));
}

void ControllerLink::ask(char verb, std::string_view payload, double now) {
  asked_ = Asked{verb, ++sequence_, now};
  wire_->write(encode(verb, sequence_, hello_->hash, payload));
}

std::vector<LinkEvent> ControllerLink::poll(double now) {
  std::vector<LinkEvent> events;
  if (!wire_) open(now);
  if (!wire_) return events;
  const std::string bytes = wire_->read();
  for (const char c : bytes) {
    if (c == '\n')
      hear(std::exchange(line_, {}), now, events);
    else if (line_.size() < longest_line)
      line_ += c;
  }
  if (wire_->is_gone()) {
    wire_.reset();
    asked_.reset();
    figures_.is_gone = true;
    next_open_ = now + reopen_after;
    events.push_back({LinkEvent::Kind::gone});
    return events;
  }
  if (asked_ && now - asked_->time > times::answer) {
    const Asked asked = *std::exchange(asked_, std::nullopt);
    if (asked.verb != 'H') {
      ++figures_.errors;
      events.push_back({LinkEvent::Kind::lost, asked.verb});
    }
    needs_hello_ = true;
  }
  if (needs_hello_ && !asked_ && now >= next_hello_) say_hello(now);
  return events;
}

void ControllerLink::hear(std::string_view line, double now, std::vector<LinkEvent>& events) {
  ++figures_.lines;
  const auto reply = read_reply(line);
  if (reply) return take(*reply, now, events);
  if (!is_new_) return damage(events);  // before the first hello anything may come
}

void ControllerLink::damage(std::vector<LinkEvent>& events) {
  ++figures_.errors;
  figures_.damaged_line = figures_.lines;
  const char verb = asked_ ? asked_->verb : '\0';
  asked_.reset();
  needs_hello_ = true;
  next_hello_ = -1e9;
  events.push_back({LinkEvent::Kind::damaged, verb});
}

void ControllerLink::take(const RawReply& reply, double now, std::vector<LinkEvent>& events) {
  const bool is_refusal = reply.verb == '!';
  const auto error =
      is_refusal && !reply.payload.empty() ? static_cast<WireError>(reply.payload[0]) : WireError::none;
  if (is_refusal && is_damage(error)) {
    if (!is_new_) damage(events);
    return;
  }
  if (!asked_ || reply.sequence != asked_->sequence || (!is_refusal && reply.verb != asked_->verb))
    return;  // late: its request was given up
  figures_.heard = now;
  const Asked asked = *std::exchange(asked_, std::nullopt);
  figures_.round_trip += (figures_.round_trip > 0 ? smoothing : 1) * (now - asked.time - figures_.round_trip);
  if (asked.verb == 'H') return take_hello(reply, events);
  if (error == WireError::other_session) needs_hello_ = true;
  events.push_back({LinkEvent::Kind::answer, asked.verb, reply.mode, error, reply.payload});
}

void ControllerLink::take_hello(const RawReply& reply, std::vector<LinkEvent>& events) {
  const auto hello = read_hello(reply.payload);
  if (!hello) return;
  const bool is_same = hello_ && hello_->hash == hello->hash && hello->session() == (sequence_ + 1) >> 16U;
  const bool is_found = std::exchange(is_new_, false) || !is_same;
  hello_ = hello;
  sequence_ = hello->last;
  needs_hello_ = false;
  LinkEvent event{is_found ? LinkEvent::Kind::found : LinkEvent::Kind::answer, 'H', reply.mode};
  event.is_same_session = is_same;
  events.push_back(std::move(event));
}

}  // namespace sinew::server::device
