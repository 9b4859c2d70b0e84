/// @file session.h
/// Requests in, replies and motion out. The drives' setpoints change in two places only: `arm`, where they
/// become what the drives measure, and `pose`, after checksum, hash, sequence number, arming and limits have
/// all passed. Every line that ends gets one reply. Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_SESSION_H
#define SINEW_FIRMWARE_SESSION_H

#include "protocol/arm.h"
#include "protocol/epoch.h"
#include "protocol/frame.h"

namespace sinew {
namespace firmware {

constexpr Uint8 protocol_version = 1;
constexpr Uint16 link_timeout = 200;  ///< [ms] without a valid frame, then the drives are disabled

enum class State : Uint8 { disarmed, armed, lost };

inline const char* text_of(State state) {
  return state == State::armed ? "armed" : state == State::lost ? "lost" : "disarmed";
}

/// @tparam Board has
///   - `void send(char)`, which may wait;
///   - `Uint16 milliseconds()`, from any start, wrapping round;
///   - `void enable(bool)`: the drives;
///   - `void exchange(const Counts& setpoints, Counts& measured)`, at once in both directions;
///   - `Uint8 eeprom_read(Uint16 address)`, `void eeprom_write(Uint16 address, Uint8)`.
template <class Board>
class Session {
 public:
  explicit Session(Board& board) : board_(board) {}

  /// Once after a reset.
  /// @param reset_cause a letter that the hello shows
  void start(char reset_cause) {
    reset_cause_ = reset_cause;
    begin_epoch();
  }

  /// A character from the line.
  void take(char c) {
    if (!line_.take(c)) return;
    watch();
    answer();
    line_.clear();
  }

  /// Disables the drives when the line has been silent for too long. To be called all the time.
  void watch() {
    if (state_ != State::armed || static_cast<Uint16>(board_.milliseconds() - heard_) < link_timeout) return;
    board_.enable(false);
    state_ = State::lost;
  }

  State state() const { return state_; }

 private:
  using Answer = Reply<Board>;

  void begin_epoch() {
    epoch_ = next_epoch(board_);
    last_ = (static_cast<Uint32>(epoch_) << 16) - 1;
  }

  void answer() {
    Request request{};
    Error error = line_.too_long() ? Error::too_long : read_request(line_.text(), request);
    if (error == Error::none) error = obey(request);
    if (error == Error::none) return;
    Answer reply(board_);
    reply.put('!');
    write_unsigned(reply, request.sequence);
    reply.count(static_cast<Uint8>(error)).word(text_of(state_)).word(text_of(error)).end();
  }

  Error obey(const Request& request) {
    const char verb = request.verb;
    if (verb != 'H' && verb != 'A' && verb != 'P' && verb != 'S' && verb != 'D') return Error::unknown_verb;
    if (verb != 'H') {
      const Error stale = check_fresh(request);
      if (stale != Error::none) return stale;
    }
    if (verb == 'P') return pose(request);
    const Error extra = read_numbers(request.numbers, 0, 0, 0, [](Uint16, Int32) {});
    if (extra != Error::none) return extra;
    if (verb == 'H') return hello(request);
    if (verb == 'A') return arm(request);
    if (verb == 'S') return measure_state(request);
    return disarm(request);
  }

  Error check_fresh(const Request& request) const {
    if (request.hash != table_hash) return Error::wrong_hash;
    if (epoch_ == 0) return Error::no_session;
    if (static_cast<Uint16>(request.sequence >> 16) != epoch_) return Error::other_session;
    return request.sequence > last_ ? Error::none : Error::replayed;
  }

  /// From here on this number and those below it are used up. The last of a session begins the next one, in
  /// which the host just counts on.
  void accept(const Request& request) {
    last_ = request.sequence;
    heard_ = board_.milliseconds();
    if ((last_ & 0xFFFF) == 0xFFFF) begin_epoch();
  }

  Answer& begin(Answer& reply, const Request& request) {
    reply.put('+');
    reply.put(request.verb);
    return reply.count(request.sequence).word(text_of(state_));
  }

  /// Changes nothing, and so asks for neither hash nor fresh number: a host learns both here.
  Error hello(const Request& request) {
    Answer reply(board_);
    begin(reply, request).count(protocol_version).count(section_count).count(tendon_count);
    reply.count(format_of(Angle{}).bits).count(format_of(Angle{}).fraction);
    reply.count(format_of(Length{}).bits).count(format_of(Length{}).fraction);
    reply.hex(table_hash).count(last_);
    reply.put(' ');
    reply.put(reset_cause_);
    reply.end();
    return Error::none;
  }

  /// Where the drives are. Of two exchanges: drives that sample when LATCH rises answer of the one before.
  void read_drives(Counts& measured) {
    board_.exchange(setpoints_, measured);
    board_.exchange(setpoints_, measured);
  }

  /// Where the drives are becomes where they shall be, and only then they are enabled: nothing moves.
  Error arm(const Request& request) {
    if (state_ != State::armed) {
      Counts measured;
      read_drives(measured);
      if (!is_plausible(measured)) return Error::drives;
      for (Uint8 i = 0; i < drive_count; ++i) setpoints_[i] = measured[i];
      board_.exchange(setpoints_, measured);
      board_.enable(true);
      state_ = State::armed;
    }
    return acknowledge(request);
  }

  Error disarm(const Request& request) {
    board_.enable(false);
    state_ = State::disarmed;
    return acknowledge(request);
  }

  Error acknowledge(const Request& request) {
    accept(request);
    Answer reply(board_);
    begin(reply, request).end();
    return Error::none;
  }

  Error pose(const Request& request) {
    Bends bends;
    const Error error = read_numbers(
        request.numbers, bend_count, Angle::smallest, Angle::largest, [&bends](Uint16 i, Int32 value) {
          bend_at(bends, static_cast<Uint8>(i)) = Angle::from_raw(static_cast<typename Angle::Raw>(value));
        });
    if (error != Error::none) return error;
    if (state_ != State::armed) return Error::not_armed;
    Changes changes;
    Counts counts, measured;
    if (!plan(bends, changes, counts)) return Error::out_of_limits;
    for (Uint8 i = 0; i < drive_count; ++i) setpoints_[i] = counts[i];
    board_.exchange(setpoints_, measured);
    accept(request);
    Answer reply(board_);
    begin(reply, request);
    for (Uint8 i = 0; i < drive_count; ++i) reply.number(change_at(changes, i).raw);
    for (Uint8 i = 0; i < drive_count; ++i) reply.number(setpoints_[i]);
    reply.end();
    return Error::none;
  }

  Error measure_state(const Request& request) {
    Counts measured;
    read_drives(measured);
    accept(request);
    Bends bends;
    States states;
    measure(measured, bends, states);
    Answer reply(board_);
    begin(reply, request);
    for (Uint8 i = 0; i < drive_count; ++i) reply.number(measured[i]);
    for (Uint8 i = 0; i < bend_count; ++i) reply.number(bend_at(bends, i).raw);
    reply.put(' ');
    for (Uint8 i = 0; i < drive_count; ++i) reply.put(letter_of(states[i / tendon_count][i % tendon_count]));
    reply.end();
    return Error::none;
  }

  struct Format {
    Uint8 bits, fraction;
  };
  template <int Bits, int Fraction>
  static constexpr Format format_of(kernel::Fixed<Bits, Fraction>) {
    return {Bits, Fraction};
  }

  Board& board_;
  Line<32 + 7 * bend_count> line_;  // longest request: 30 and 7 a bend
  Counts setpoints_ = {};
  Uint32 last_ = 0;
  Uint16 epoch_ = 0, heard_ = 0;
  State state_ = State::disarmed;
  char reset_cause_ = '-';
};

}  // namespace firmware
}  // namespace sinew

#endif
