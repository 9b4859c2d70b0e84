/// @file session.h
/// Requests in, replies and motion out. The drives' setpoints change in few places only: `arm` and
/// `set_zero`, where they become what the drives measure; `pose` and `move_drives`, after checksum, hash,
/// sequence number, arming and limits have all passed; and `refresh`, where a ramp takes them there. Every
/// line that ends gets one reply.
/// Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_SESSION_H
#define SINEW_FIRMWARE_SESSION_H

#include "protocol/arm.h"
#include "protocol/binary.h"
#include "protocol/epoch.h"
#include "protocol/frame.h"
#include "protocol/ramp.h"
#include "protocol/tension_guard.h"
#include "protocol/zeros.h"

namespace sinew {
namespace firmware {

constexpr Uint8 protocol_version = 3;
constexpr Uint16 link_timeout = 200;  ///< [ms] without a valid frame, then the drives are disabled
constexpr Uint8 damage_limit = 5;     ///< damaged exchanges in a row, then the drives are disabled

/// @tparam Board has
///   - `Uint8 room()` for replies; `void put(Uint8)` and `void put(const Uint8*, Uint8 size)` where there is
///     some; `void flush()` after some of these;
///   - `Uint16 milliseconds()`, from any start, wrapping round;
///   - `void enable(bool)`: the drives;
///   - `bool exchange(const Counts& setpoints)` with the drives, in both directions at once: whether the
///   checksum
///     of what they measure holds; `Int32 measured(Uint8 drive)` and, where drives measure it,
///     `Uint16 tension(Uint8 tendon)` in the last exchange;
///   - `Uint8 eeprom_read(Uint16 address)`, `void eeprom_write(Uint16 address, Uint8)`, which may wait until
///     `bool is_eeprom_ready()`.
template <class Board>
class Session {
 public:
  explicit Session(Board& board) : board_(board) {}

  /// Once after a reset.
  /// @param reset_cause a letter that the hello shows
  void start(char reset_cause) {
    reset_cause_ = reset_cause;
    ticked_ = board_.milliseconds();
    begin_epoch();
  }

  /// Bytes from the line, up to the end of one: how many it took. Answers are given by `answer`.
  Uint8 collect(const volatile Uint8* bytes, Uint8 size) { return line_.collect(bytes, size); }
  /// If a line has ended.
  void answer() {
    if (!line_.has_ended()) return;
    watch();
    if (line_.is_binary())
      answer_binary();
    else
      answer_text();
    line_.clear();
  }

  /// What time asks for: setpoints on their way, and drives disabled when the line has been silent for too
  /// long. To be called at least once a millisecond.
  __attribute__((noinline)) void watch() {
    const Uint16 now = board_.milliseconds(), ticks = static_cast<Uint16>(now - ticked_);
    if (ticks == 0) return;
    ticked_ = now;
    if (next_epoch_.is_begun()) next_epoch_.step(board_);
    if (state_ != State::armed) return;
    if (static_cast<Uint16>(now - heard_) >= link_timeout)
      disable(State::lost);
    else
      refresh(ticks);
  }

  /// For replies: they wait for room on the line. Time does not.
  void wait_for_room(Uint8 bytes) {
    while (board_.room() < bytes) watch();
  }
  void put(Uint8 byte) { board_.put(byte); }
  void put(const Uint8* bytes, Uint8 size) { board_.put(bytes, size); }
  void flush() { board_.flush(); }
  void send(char c) {
    wait_for_room(1);
    put(static_cast<Uint8>(c));
    flush();
  }

  State state() const { return state_; }

 private:
  void begin_epoch() {
    if (!next_epoch_.is_begun()) next_epoch_.begin(board_);
    while (!next_epoch_.step(board_)) {
    }
    epoch_ = next_epoch_.take();
    last_ = (static_cast<Uint32>(epoch_) << 16) - 1;
  }

  void disable(State state) {
    board_.enable(false);
    ramp_.stop();
    state_ = state;
  }

  void answer_text() {
    TextRequest request{};
    Error error = line_.too_long() ? Error::too_long : read_request(line_.text(), request);
    if (error == Error::none) error = obey(request);
    if (error != Error::none) TextReply<Session>(*this).refuse(request.sequence, error, state_);
  }
  void answer_binary() {
    BinaryRequest request{};
    Error error = line_.too_long() ? Error::too_long : read_request(line_.bytes(), line_.size(), request);
    if (error == Error::none) error = obey(request);
    if (error != Error::none) BinaryReply<Session>(*this).refuse(request.sequence, error, state_);
  }

  template <class Request>
  Error obey(const Request& request) {
    const char verb = request.verb;
    const bool is_of_drives = request.has_drives && (verb == 'T' || verb == 'Z');
    if (verb != 'H' && verb != 'A' && verb != 'P' && verb != 'S' && verb != 'D' && !is_of_drives)
      return Error::unknown_verb;
    if (verb != 'H') {
      const Error stale = check_fresh(request.sequence, request.hash);
      if (stale != Error::none) return stale;
    }
    if (verb == 'P') return pose(request);
    if (is_of_drives) return verb == 'T' ? move_drives(request) : set_zero(request);
    const Error extra = expect_nothing(request);
    if (extra != Error::none) return extra;
    if (verb == 'H') return hello(request);
    if (verb == 'A') return arm(request);
    if (verb == 'S') return measure_state(request);
    return disarm(request);
  }

  Error check_fresh(Uint32 sequence, Uint32 hash) const {
    if (hash != table_hash) return Error::wrong_hash;
    if (epoch_ == 0) return Error::no_session;
    if (static_cast<Uint16>(sequence >> 16) != epoch_) return Error::other_session;
    return sequence > last_ ? Error::none : Error::replayed;
  }

  static Error expect_nothing(const TextRequest& request) {
    return read_numbers(request.numbers, 0, [](Uint16, Int32) { return true; });
  }
  static Error expect_nothing(const BinaryRequest& request) {
    return request.size == 0 ? Error::none : Error::wrong_count;
  }

  static Error read_pose(const TextRequest& request, Pose& pose) {
    return read_numbers(request.numbers, bend_count + stage_count, [&pose](Uint16 i, Int32 value) {
      if (i == bend_count) {
        pose.stage = value;
        return true;
      }
      bend_at(pose.bends, static_cast<Uint8>(i)) = Angle::from_raw(static_cast<typename Angle::Raw>(value));
      return value >= Angle::smallest && value <= Angle::largest;
    });
  }
  static Error read_pose(const BinaryRequest& request, Pose& pose) {
    static_assert(Angle::bits == 16, "a bend has two bytes");
    if (request.size != 2 + 2 * bend_count + 4 * stage_count) return Error::wrong_count;
    const Uint8* at = request.payload;
    pose.duration = read16(at);
    at += 2;
    for (Uint8 i = 0; i < bend_count; ++i, at += 2)
      bend_at(pose.bends, i) = Angle::from_raw(static_cast<Int16>(read16(at)));
    if (stage_count > 0) pose.stage = static_cast<Int32>(read32(at));
    return Error::none;
  }

  /// From here on this number and those below it are used up. The last of a session begins the next one, in
  /// which the host just counts on; shortly before, its number goes into the EEPROM byte by byte.
  void accept(Uint32 sequence) {
    constexpr Uint16 prepared = 0xF000;
    last_ = sequence;
    heard_ = board_.milliseconds();
    if ((last_ & 0xFFFF) == 0xFFFF)
      begin_epoch();
    else if ((last_ & 0xFFFF) >= prepared && !next_epoch_.is_begun())
      next_epoch_.begin(board_);
  }

  /// Changes nothing, and so asks for neither hash nor fresh number: a host learns both here.
  Error hello(const TextRequest& request) {
    TextReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    reply.count(protocol_version).count(section_count).count(tendon_count);
    reply.count(format_of(Angle{}).bits).count(format_of(Angle{}).fraction);
    reply.count(format_of(Length{}).bits).count(format_of(Length{}).fraction);
    reply.hex(table_hash).count(last_);
    reply.put(' ');
    reply.put(reset_cause_);
    if (stage_count > 0) reply.number(stage_limit);
    reply.end();
    return Error::none;
  }
  Error hello(const BinaryRequest& request) {
    BinaryReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    const Uint8 shape[] = {protocol_version,
                           section_count,
                           tendon_count,
                           stage_count,
                           format_of(Angle{}).bits,
                           format_of(Angle{}).fraction,
                           format_of(Length{}).bits,
                           format_of(Length{}).fraction};
    for (const Uint8 byte : shape) reply.put(byte);
    reply.put32(table_hash);
    reply.put32(last_);
    reply.put32(stage_count > 0 ? static_cast<Uint32>(stage_limit) : 0);
    reply.put(static_cast<Uint8>(reset_cause_));
    reply.put(static_cast<Uint8>((has_tensions ? 1 : 0) | (has_homing ? 2 : 0)));
    reply.put16(tension_limit);
    reply.end();
    return Error::none;
  }

  /// Where the drives are. Of two exchanges: drives that sample when LATCH rises answer of the one before.
  bool read_drives(Counts& measured) {
    exchange();
    const bool is_whole = exchange();
    for (Uint8 i = 0; i < drive_count; ++i) measured[i] = zeros_.to_host(i, board_.measured(i));
    return is_whole;
  }

  bool exchange() {
    is_refreshed_ = true;
    Counts of_drives;
    const bool is_whole = board_.exchange(zeros_.to_drives(setpoints_, of_drives));
    if (!is_whole && damaged_ != 0xFFFF) ++damaged_;
    if (is_whole && tension_limit > 0) obey_tensions();
    return is_whole;
  }
  /// A tendon that has come above the limit stops all; from then on only what takes it in is stopped, so that
  /// the others may be paid out, too.
  __attribute__((noinline)) void obey_tensions() {
    const bool is_new = guard_.look(board_);
    if (ramp_.is_running() && (is_new || guard_.forbids(setpoints_, ramp_.target()))) ramp_.stop();
  }

  /// The drives get the setpoints that hold now. What a damaged exchange has not brought, the next one does;
  /// a wire that brings nothing disables them.
  void tell_drives() {
    if (exchange())
      damaged_in_a_row_ = 0;
    else if (++damaged_in_a_row_ >= damage_limit)
      disable(State::lost);
  }

  /// Between two poses all stays within limits: bends that are allowed form a convex set, and counts by LSK
  /// are linear in bends, so counts on the way belong to bends on the way. By exact PCC they do so nearly;
  /// each tendon is between two lengths that it may have.
  void refresh(Uint16 ticks) {
    if (ramp_.is_running()) {
      ramp_.advance(ticks, setpoints_);
      tell_drives();
    } else if (!is_refreshed_) {
      tell_drives();
    }
    is_refreshed_ = false;
  }

  /// Where the drives are becomes where they shall be, and only then they are enabled: nothing moves.
  template <class Request>
  Error arm(const Request& request) {
    if (state_ != State::armed) {
      Counts measured;
      if (!read_drives(measured) || !is_plausible(measured)) return Error::drives;
      for (Uint8 i = 0; i < drive_count; ++i) setpoints_[i] = measured[i];
      // The second says whether the drives have taken the first: they would leave for an older setpoint.
      if (!exchange() || !exchange()) return Error::drives;
      damaged_in_a_row_ = 0;
      board_.enable(true);
      state_ = State::armed;
    }
    return acknowledge(request);
  }

  template <class Request>
  Error disarm(const Request& request) {
    disable(State::disarmed);
    return acknowledge(request);
  }

  Error acknowledge(const TextRequest& request) {
    accept(request.sequence);
    TextReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    reply.end();
    return Error::none;
  }
  Error acknowledge(const BinaryRequest& request) {
    accept(request.sequence);
    BinaryReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    reply.end();
    return Error::none;
  }

  template <class Request>
  Error pose(const Request& request) {
    Pose pose;
    const Error error = read_pose(request, pose);
    if (error != Error::none) return error;
    if (state_ != State::armed) return Error::not_armed;
    if (!is_within_limits(pose)) return Error::out_of_limits;
    if (!zeros_.are_set()) return Error::not_homed;
    if (tension_limit > 0) return pose_guarded(request, pose);
    accept(request.sequence);
    const bool is_ramp = pose.duration > 1;
    Counts& counts = is_ramp ? ramp_.target() : setpoints_;
    Changes changes;
    plan(pose, changes, counts);
    if (is_ramp) {
      ramp_.begin(setpoints_, pose.duration);
    } else {
      ramp_.stop();
      tell_drives();
    }
    answer_pose(request, changes, counts);
    return Error::none;
  }
  /// Setpoints and ramp stay as they are until it is known that no tension refuses it. Apart from the above,
  /// which has no time for that.
  template <class Request>
  Error pose_guarded(const Request& request, const Pose& pose) {
    Changes changes;
    Counts counts;
    plan(pose, changes, counts);
    const Error error = go_to(counts, pose.duration, request.sequence);
    if (error == Error::none) answer_pose(request, changes, counts);
    return error;
  }
  __attribute__((noinline)) Error go_to(const Counts& counts, Uint16 duration, Uint32 sequence) {
    if (guard_.forbids(setpoints_, counts)) return Error::over_tension;
    accept(sequence);
    const bool is_ramp = duration > 1;
    Counts& goal = is_ramp ? ramp_.target() : setpoints_;
    for (Uint8 i = 0; i < drive_count; ++i) goal[i] = counts[i];
    if (is_ramp) {
      ramp_.begin(setpoints_, duration);
    } else {
      ramp_.stop();
      tell_drives();
    }
    return Error::none;
  }

  /// Single drives, which is how a host looks for the ends of tendons before it may ask for a pose.
  Error move_drives(const BinaryRequest& request) {
    if (request.size != move_bytes) return Error::wrong_count;
    if (state_ != State::armed) return Error::not_armed;
    Counts counts;
    const bool are_near = !zeros_.are_set();
    for (Uint8 i = 0; i < drive_count; ++i) {
      counts[i] = static_cast<Int32>(read32(request.payload + 2 + 4 * i));
      if (!is_allowed(i, counts[i])) return Error::out_of_limits;
      if (are_near && i < tendon_drives && !is_near(setpoints_[i], counts[i])) return Error::out_of_limits;
    }
    const Error error = go_to(counts, read16(request.payload), request.sequence);
    if (error != Error::none) return error;
    Changes none;
    answer_pose(request, none, counts);
    return Error::none;
  }
  Error move_drives(const TextRequest&) { return Error::unknown_verb; }
  /// As far as a drive may go that does not know where it is: 30 mm.
  static bool is_near(Int32 from, Int32 to) {
    const Int32 most = robot::motor.of(Length(30.0));
    // Modulo 2^32, so that no difference of two counts overflows.
    const Uint32 way = to > from ? static_cast<Uint32>(to) - static_cast<Uint32>(from)
                                 : static_cast<Uint32>(from) - static_cast<Uint32>(to);
    return way <= static_cast<Uint32>(most);
  }

  /// Where a drive is now gets a count; it stays there.
  Error set_zero(const BinaryRequest& request) {
    if (request.size != 5) return Error::wrong_count;
    const Uint8 drive = request.payload[0];
    const Int32 count = static_cast<Int32>(read32(request.payload + 1));
    if (drive >= drive_count) return Error::out_of_range;
    if (state_ != State::armed) return Error::not_armed;
    if (!is_allowed(drive, count)) return Error::out_of_limits;
    if (ramp_.is_running()) return Error::moving;
    Counts measured;
    if (!read_drives(measured)) return Error::drives;
    accept(request.sequence);
    zeros_.set(drive, board_.measured(drive), count);
    setpoints_[drive] = count;
    tell_drives();
    return acknowledge(request);
  }
  Error set_zero(const TextRequest&) { return Error::unknown_verb; }

  void answer_pose(const TextRequest& request, Changes& changes, const Counts& counts) {
    TextReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    for (Uint8 i = 0; i < tendon_drives; ++i) reply.number(change_at(changes, i).raw);
    for (const Int32 count : counts) reply.number(count);
    reply.end();
  }
  void answer_pose(const BinaryRequest& request, Changes&, const Counts& counts) {
    BinaryReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    reply.put_setpoints(counts);
    reply.end();
  }

  template <class Request>
  Error measure_state(const Request& request) {
    Counts measured;
    if (!read_drives(measured)) return Error::drives;
    accept(request.sequence);
    Bends bends;
    States states;
    measure(measured, bends, states, [this] { watch(); });
    answer_state(request, measured, bends, states);
    return Error::none;
  }
  void answer_state(const TextRequest& request, const Counts& measured, Bends& bends, const States& states) {
    TextReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    for (const Int32 count : measured) reply.number(count);
    for (Uint8 i = 0; i < bend_count; ++i) reply.number(bend_at(bends, i).raw);
    reply.put(' ');
    for (Uint8 i = 0; i < tendon_drives; ++i) reply.put(letter_at(states, i));
    reply.end();
  }
  void answer_state(const BinaryRequest& request, const Counts& measured, Bends& bends,
                    const States& states) {
    BinaryReply<Session> reply(*this);
    reply.begin(request.verb, request.sequence, state_);
    reply.put_counts(measured);
    for (Uint8 i = 0; i < bend_count; ++i) reply.put16(static_cast<Uint16>(bend_at(bends, i).raw));
    for (Uint8 i = 0; i < tendon_drives; ++i) reply.put(static_cast<Uint8>(letter_at(states, i)));
    reply.put16(damaged_);
    for (Uint8 i = 0; i < homed_bytes; ++i) reply.put(zeros_.bits(i));
    if (has_tensions)
      for (Uint8 i = 0; i < tendon_drives; ++i) reply.put16(board_.tension(i));
    reply.end();
  }

  struct Format {
    Uint8 bits, fraction;
  };
  template <int Bits, int Fraction>
  static constexpr Format format_of(kernel::Fixed<Bits, Fraction>) {
    return {Bits, Fraction};
  }

  Board& board_;
  // The longest request is a pose in ASCII, 30 characters, 7 a bend, 12 a stage, or the setpoints of drives.
  static constexpr Uint16 pose_line = 32 + 7 * bend_count + 12 * stage_count,
                          move_line = has_homing ? 16 + move_bytes : 0;
  Line<(move_line > pose_line ? move_line : pose_line)> line_;
  Counts setpoints_ = {};  ///< what the drives are told, from the host's zeros
  Ramp<drive_count> ramp_;
  Zeros<drive_count, has_homing> zeros_;
  TensionGuard<tendon_drives, tension_limit> guard_;
  NextEpoch next_epoch_;
  Uint32 last_ = 0;
  Uint16 epoch_ = 0, heard_ = 0, ticked_ = 0;
  Uint16 damaged_ = 0;  ///< exchanges since the reset, 65535 and more
  Uint8 damaged_in_a_row_ = 0;
  bool is_refreshed_ = false;  ///< in this millisecond
  State state_ = State::disarmed;
  char reset_cause_ = '-';
};

}  // namespace firmware
}  // namespace sinew

#endif
