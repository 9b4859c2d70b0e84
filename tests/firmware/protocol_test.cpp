#include <gtest/gtest.h>

#include "desk.hpp"
#include "noise.hpp"

namespace sinew::firmware {
namespace protocol_test {

const std::vector<int> straight(pose_size, 0);

std::vector<int> some_pose() {
  std::vector<int> bends(pose_size);
  for (int i = 0; i < static_cast<int>(pose_size); ++i)
    bends[static_cast<std::size_t>(i)] = 100 * (i + 1) * (i % 2 ? -1 : 1);
  return bends;
}

int code(Error error) { return static_cast<int>(error); }

void expect_refused(const Answer& answer, Error error) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, '!');
  EXPECT_EQ(answer.code, code(error)) << text_of(error);
}
void expect_accepted(const Answer& answer, char verb, const std::string& state) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, verb) << "code " << answer.code;
  EXPECT_EQ(answer.state, state);
}

Reading reading_of(const std::string& text, Int32& value) {
  Text rest{text.data(), text.data() + text.size()};
  const Reading reading = read_integer(rest, -32768, 32767, value);
  return reading == Reading::good && !rest.empty() ? Reading::malformed : reading;
}

TEST(FirmwareNumber, HasOneSpelling) {
  for (const int value : {0, 1, -1, 9, 10, -10, 32767, -32768}) {
    Int32 read = 0;
    EXPECT_EQ(reading_of(std::to_string(value), read), Reading::good) << value;
    EXPECT_EQ(read, value);
  }
  for (const char* text : {"", "-", "+1", "01", "-01", "-0", "00", " 1", "1 ", "1.", "0x1", "1e3", "--1"}) {
    Int32 read = 0;
    EXPECT_EQ(reading_of(text, read), Reading::malformed) << text;
  }
  for (const char* text : {"32768", "-32769", "2147483647", "2147483648", "-2147483648", "4294967295",
                           "4294967296", "99999999999999999999999999"}) {
    Int32 read = 0;
    EXPECT_EQ(reading_of(text, read), Reading::out_of_range) << text;
  }
}

struct StringSink {
  void put(char c) { text += c; }
  std::string text;
};

TEST(FirmwareNumber, IsWrittenAsItIsRead) {
  std::mt19937 random(1);
  for (int i = 0; i < 100000; ++i) {
    const auto bits = static_cast<Uint32>(random()) >> (random() % 32);
    StringSink plain, with_sign, in_hex;
    write_unsigned(plain, bits);
    write_integer(with_sign, static_cast<Int32>(0 - bits));
    write_hex(in_hex, bits);
    ASSERT_EQ(plain.text, std::to_string(bits));
    ASSERT_EQ(with_sign.text, std::to_string(static_cast<Int32>(0 - bits)));
    ASSERT_EQ(in_hex.text, hex(bits));
  }
}

TEST(FirmwareMotor, CountsOf16BitsAreThoseOf64) {
  using Motor = kernel::MotorCounts<kernel::Fixed<16, 8>>;
  for (const std::int32_t per_step : {1, 65535, 65536, 524288, 17 * 65536 + 20000, 0x7FFFFFFF}) {
    const Motor motor{per_step};
    for (int raw = -32768; raw <= 32767; ++raw) {
      const auto expected = static_cast<std::int32_t>((std::int64_t{raw} * per_step + 32768) >> 16);
      ASSERT_EQ(motor.of(kernel::Fixed<16, 8>::from_raw(static_cast<std::int16_t>(raw))), expected) << raw;
    }
  }
}

TEST(FirmwareFrame, ChecksumIsZlibs) {
  EXPECT_EQ(slow_crc32("123456789"), 0xCBF43926u);
  const std::string line = "123456789*cbf43926", wrong = "123456789*cbf43927", upper = "123456789*CBF43926";
  const auto checked = [](const std::string& text) {
    Text rest{text.data(), text.data() + text.size()};
    return check(rest);
  };
  EXPECT_EQ(checked(line), Error::none);
  EXPECT_EQ(checked(wrong), Error::checksum);
  EXPECT_EQ(checked(upper), Error::truncated);
}

TEST(FirmwareSession, HelloSaysWhatAHostHasToKnow) {
  Desk desk;
  const Answer answer = desk.ask(request('H', 7, {}, 0));
  expect_accepted(answer, 'H', "disarmed");
  EXPECT_EQ(answer.sequence, 7u);
  const std::vector<std::string> expected = {std::to_string(protocol_version),
                                             std::to_string(section_count),
                                             std::to_string(tendon_count),
                                             "16",
                                             std::to_string(Angle::fraction),
                                             "16",
                                             std::to_string(Length::fraction),
                                             hex(table_hash),
                                             "65535",
                                             "p"};
  EXPECT_EQ(std::vector(answer.rest.begin(), answer.rest.begin() + 10), expected);
  EXPECT_EQ(answer.rest.size(), 10u + stage_count);
}

TEST(FirmwareSession, ArmingMovesNothing) {
  Desk desk;
  for (std::size_t i = 0; i < drive_count; ++i) desk.board.positions[i] = static_cast<int>(1000 * i) - 7;
  const auto before = desk.board.positions;
  expect_refused(desk.ask('P', straight), Error::not_armed);
  EXPECT_EQ(desk.board.exchanges, 0);
  expect_accepted(desk.ask('A'), 'A', "armed");
  EXPECT_TRUE(desk.board.enabled);
  EXPECT_EQ(desk.board.setpoints, before);
  EXPECT_EQ(desk.board.positions, before);
  expect_accepted(desk.ask('A'), 'A', "armed");  // again: nothing but a sign of life
  EXPECT_EQ(desk.board.exchanges, 4);
  expect_accepted(desk.ask('D'), 'D', "disarmed");
  EXPECT_FALSE(desk.board.enabled);
}

/// The same by the table in floating point [mm].
std::vector<double> float_changes(std::span<const int> raw) {
  const double step = static_cast<double>(Angle::from_raw(1));
  kernel::Bend<float> bends[section_count];
  float changes[section_count][tendon_count];
  for (std::size_t m = 0; m < section_count; ++m)
    bends[m] = {static_cast<float>(raw[2 * m] * step), static_cast<float>(raw[2 * m + 1] * step)};
  robot::table_float.changes(bends, changes);
  return {&changes[0][0], &changes[0][0] + tendon_drives};
}

/// Nor when the wire damages any one of the exchanges on the way to the drives.
TEST(FirmwareSession, ArmingMovesNothingByADamagedExchange) {
  for (int refused = 0; refused <= 6; ++refused) {
    Desk desk;
    desk.board.positions.fill(500);
    desk.board.refused_exchange = refused;
    const Answer answer = desk.ask('A');
    for (const std::int32_t position : desk.board.positions) EXPECT_EQ(position, 500) << refused;
    EXPECT_EQ(desk.board.enabled, answer.verb == 'A') << refused;
    if (!desk.board.enabled) {
      EXPECT_EQ(desk.ask('A').verb, 'A') << refused;
    }
    for (const std::int32_t position : desk.board.positions) EXPECT_EQ(position, 500) << refused;
  }
}

TEST(FirmwareSession, PoseBecomesCountsOfTheDrives) {
  Desk desk;
  desk.ask('A');
  const Answer answer = desk.ask('P', some_pose());
  expect_accepted(answer, 'P', "armed");
  ASSERT_EQ(answer.rest.size(), 0u + tendon_drives + drive_count);
  const auto expected = expected_setpoints(some_pose());
  const auto nearly = float_changes(some_pose());
  for (std::size_t i = 0; i < drive_count; ++i) {
    EXPECT_EQ(desk.board.setpoints[i], expected[i]);
    EXPECT_EQ(answer.rest[tendon_drives + i], std::to_string(expected[i]));
    if (i >= tendon_drives) continue;
    const auto change = Length::from_raw(static_cast<Length::Raw>(std::stoi(answer.rest[i])));
    EXPECT_EQ(robot::motor.of(change), expected[i]);
    EXPECT_NEAR(static_cast<double>(change), nearly[i], static_cast<double>(Length::from_raw(1)));
  }
}

TEST(FirmwareSession, StateIsWhatTheDrivesMeasure) {
  Desk desk;
  desk.ask('A');
  desk.ask('P', some_pose());
  Answer answer = desk.ask('S');
  expect_accepted(answer, 'S', "armed");
  ASSERT_EQ(answer.rest.size(), drive_count + bend_count + 1u);
  for (std::size_t i = 0; i < bend_count; ++i)  // as exactly as a step of the tendons tells
    EXPECT_NEAR(std::stoi(answer.rest[drive_count + i]), some_pose()[i], 8);
  EXPECT_EQ(answer.rest.back(), std::string(tendon_drives, 'e'));
  // A tendon far too long: three cannot tell which it is, and share what they have in common.
  const auto setpoints = desk.board.setpoints;
  desk.board.enabled = false;  // they stay where they are put
  desk.board.positions[0] += robot::motor.of(Length(10.0));
  answer = desk.ask('S');
  EXPECT_EQ(answer.rest.back().substr(0, tendon_count), "sss");
  desk.board.positions[0] -= robot::motor.of(Length(20.0));
  EXPECT_EQ(desk.ask('S').rest.back().substr(0, tendon_count), "ooo");
  EXPECT_EQ(desk.board.setpoints, setpoints);
}

TEST(FirmwareSession, LimitsAreTheRobots) {
  Desk desk;
  desk.ask('A');
  const int limit = robot::limits.limit[0];
  for (std::size_t i = 0; i < bend_count; ++i)
    for (const int sign : {-1, 1}) {
      std::vector<int> bends = straight;
      bends[i] = sign * limit;
      expect_accepted(desk.ask('P', bends), 'P', "armed");
      const auto before = desk.board.setpoints;
      bends[i] = sign * (limit + 1);
      expect_refused(desk.ask('P', bends), Error::out_of_limits);
      EXPECT_EQ(desk.board.setpoints, before);
    }
}

TEST(FirmwareSession, ErrorsHaveNames) {
  Desk desk;
  desk.ask('A');
  const std::uint32_t next = desk.last + 1;
  std::vector<int> few = straight, many = straight, large = straight;
  few.pop_back();
  many.push_back(0);
  large[0] = 32768;
  expect_refused(desk.ask(std::string(500, '1')), Error::too_long);
  expect_refused(desk.ask(""), Error::truncated);
  expect_refused(desk.ask("P 1 2 3"), Error::truncated);
  expect_refused(desk.ask(request('P', next, straight) + "0"), Error::truncated);
  expect_refused(desk.ask("X" + request('P', next, straight)), Error::checksum);
  expect_refused(desk.ask(framed("")), Error::malformed);
  expect_refused(desk.ask(framed("P  1 2")), Error::malformed);
  expect_refused(desk.ask(framed("P " + std::to_string(next) + ' ' + hex(table_hash) + " +1")),
                 Error::malformed);
  expect_refused(desk.ask(framed("P 4294967296 " + hex(table_hash))), Error::out_of_range);
  expect_refused(desk.ask(request('Z', next)), Error::unknown_verb);
  expect_refused(desk.ask(request('P', next, straight, table_hash + 1)), Error::wrong_hash);
  expect_refused(desk.ask(request('P', next + 0x10000, straight)), Error::other_session);
  expect_refused(desk.ask(request('P', desk.last, straight)), Error::replayed);
  expect_refused(desk.ask(request('P', next, few)), Error::wrong_count);
  expect_refused(desk.ask(request('P', next, many)), Error::wrong_count);
  expect_refused(desk.ask(request('S', next, straight)), Error::wrong_count);
  expect_refused(desk.ask(request('P', next, large)), Error::out_of_range);
  EXPECT_EQ(desk.board.exchanges, 4);                                                // the two of arming
  expect_accepted(desk.ask(request('P', next, straight)), 'P', "armed");             // no number was used up
  expect_accepted(desk.ask(request('P', next + 1, straight) + '\r'), 'P', "armed");  // as terminals write
}

TEST(FirmwareSession, LongestRequestFits) {
  Desk desk;
  // Sequence numbers of ten digits.
  const std::array<Uint8, 8> copies{0xFD, 0xFF, 0x02, 0x00, 0xFC, 0xFF, 0x03, 0x00};
  std::copy(copies.begin(), copies.end(), desk.board.eeprom.begin() + 8);
  desk.session.start('p');
  desk.last = 0xFFFDFFFF;
  desk.ask('A');
  std::vector<int> longest(pose_size, -32768);
  if (stage_count > 0) longest.back() = -2147483647;
  expect_refused(desk.ask(request('P', desk.last + 1, longest) + '\r'), Error::out_of_limits);
}

TEST(FirmwareLink, SilenceDisablesTheDrives) {
  Desk desk;
  desk.ask('A');
  desk.wait(link_timeout - 1);
  expect_accepted(desk.ask('S'), 'S', "armed");
  desk.wait(link_timeout - 1);
  EXPECT_TRUE(desk.board.enabled);
  desk.wait(1);
  EXPECT_FALSE(desk.board.enabled);
  expect_accepted(desk.ask('S'), 'S', "lost");
  const Answer refused = desk.ask('P', straight);
  expect_refused(refused, Error::not_armed);
  EXPECT_EQ(refused.state, "lost");
  desk.wait(70000);  // the clock wraps round
  EXPECT_EQ(desk.ask('S').state, "lost");
  expect_accepted(desk.ask('A'), 'A', "armed");
  EXPECT_TRUE(desk.board.enabled);
}

TEST(FirmwareLink, OnlyAcceptedRequestsAreSignsOfLife) {
  Desk desk;
  desk.ask('A');
  const std::string stale = request('S', desk.last);
  for (int i = 0; i < link_timeout; ++i) {
    desk.ask(stale);
    desk.ask(request('H', 1, {}, 0));
    desk.ask("noise");
    EXPECT_TRUE(desk.board.enabled);
    desk.wait(1);
  }
  EXPECT_FALSE(desk.board.enabled);
}

TEST(FirmwareEpoch, RecordingsOfOtherSessionsAreRefused) {
  Desk first;
  first.ask('A');
  const std::string recorded = request('P', first.last + 1, straight);
  Desk second(&first.board.eeprom);
  second.last = 0x1FFFF;
  expect_accepted(second.ask('A'), 'A', "armed");
  expect_refused(second.ask(recorded), Error::other_session);
}

TEST(FirmwareEpoch, LastNumberOfASessionBeginsTheNext) {
  Desk desk;
  desk.ask('A');
  desk.last = 0x1FFFE;
  expect_accepted(desk.ask('S'), 'S', "armed");  // 0x1FFFF
  expect_accepted(desk.ask('S'), 'S', "armed");  // 0x20000: the host just counts on
  expect_refused(desk.ask(request('S', 0x1FFFF)), Error::other_session);
  Desk after(&desk.board.eeprom);
  expect_accepted(after.ask(request('S', 0x30000)), 'S', "disarmed");
}

TEST(FirmwareEpoch, PowerFailureNeverRepeatsOne) {
  Desk desk;
  std::uint32_t used = 1;
  for (int round = 0; round < 40; ++round) {
    desk.board.writes_until_power_fails = round % 5;
    try {
      used = std::max<std::uint32_t>(used, next_epoch(desk.board));
    } catch (const std::runtime_error&) {
    }
    desk.board.writes_until_power_fails = -1;
    const Uint16 epoch = next_epoch(desk.board);
    EXPECT_GT(epoch, used) << round;
    used = epoch;
  }
}

TEST(FirmwareEpoch, DamagedCopyRepeatsNone) {
  for (std::size_t bit = 0; bit < 64; ++bit) {
    DeskBoard board;
    for (int session = 1; session <= 4; ++session) EXPECT_EQ(next_epoch(board), session);
    board.eeprom[8 + bit / 8] ^= static_cast<Uint8>(1u << (bit % 8));
    EXPECT_GT(next_epoch(board), 4) << bit;
  }
  for (int cell = 8; cell < 16; ++cell) {
    DeskBoard board;
    board.worn = cell;
    int used = 0;
    for (int session = 0; session < 10; ++session) {
      const int epoch = next_epoch(board);
      EXPECT_GT(epoch, used) << cell;
      used = epoch;
    }
  }
}

TEST(FirmwareEpoch, WithoutOneNothingIsAccepted) {
  struct NoEeprom : DeskBoard {
    Uint8 eeprom_read(Uint16) const { return 0; }
  } board;
  Session<NoEeprom> session(board);
  session.start('p');
  for (const char c : request('A', 1, {}) + '\n') {
    const auto byte = static_cast<Uint8>(c);
    session.collect(&byte, 1);
    session.answer();
  }
  EXPECT_EQ(read_answer(board.sent.substr(0, board.sent.size() - 1)).code,
            static_cast<int>(Error::no_session));
  EXPECT_FALSE(board.enabled);
}

TEST(FirmwareSession, DrivesThatAnswerNonsenseAreNotArmed) {
  Desk desk;
  desk.board.positions.fill(-1);  // a wire is off
  expect_refused(desk.ask('A'), Error::drives);
  --desk.last;
  desk.board.positions.fill(0);
  desk.board.positions[3] = 0x7FFFFFFF;
  expect_refused(desk.ask('A'), Error::drives);
  --desk.last;
  EXPECT_FALSE(desk.board.enabled);
  desk.board.positions[3] = 100;
  expect_accepted(desk.ask('A'), 'A', "armed");
}

TEST(FirmwareEpoch, AfterTheLastComesTheFirst) {
  DeskBoard board;
  const std::array<Uint8, 8> copies{0xFF, 0xFF, 0x00, 0x00, 0xFE, 0xFF, 0x01, 0x00};
  std::copy(copies.begin(), copies.end(), board.eeprom.begin() + 8);
  EXPECT_EQ(next_epoch(board), 1);
  EXPECT_EQ(next_epoch(board), 2);
}

TEST(FirmwareSession, NothingButAFreshValidFrameMovesTheDrives) {
  const int lines = lines_of(stage_count > 0 ? 100'000 : 1'000'000);
  Desk desk;
  Noise noise(1);
  std::vector<std::string> accepted;
  desk.ask('A');
  for (int i = 0; i < lines; ++i) {
    const auto before = desk.board.setpoints;
    const int exchanges = desk.board.exchanges;
    const std::string line = noise.line(desk.last, accepted);
    const std::string replies = desk.ask_raw(line);
    ASSERT_EQ(std::ranges::count(replies, '\n'), std::ranges::count(line, '\n')) << line << replies;
    std::istringstream stream(replies);
    for (std::string reply; std::getline(stream, reply);) {
      const Answer answer = read_any_answer(reply);
      ASSERT_TRUE(answer.is_whole && answer.verb == '!') << line << reply;
    }
    ASSERT_EQ(desk.board.setpoints, before) << line;
    ASSERT_EQ(desk.board.exchanges, exchanges) << line;
    ASSERT_TRUE(desk.board.enabled) << line;
    if (i % 20 != 0) continue;
    const std::vector<int> pose = noise.pose();
    ASSERT_EQ(desk.ask('P', pose).verb, 'P');
    ASSERT_TRUE(std::ranges::equal(desk.board.setpoints, expected_setpoints(pose)));
    if (accepted.size() < 1000) accepted.push_back(request('P', desk.last, pose));
  }
}

}  // namespace protocol_test
}  // namespace sinew::firmware
