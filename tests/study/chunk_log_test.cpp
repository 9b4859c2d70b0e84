// The log of a sweep finds its whole chunks again whatever became of its end.
#include "study/results/chunk_log.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "study_folder.hpp"

namespace chunk_log_test {

using namespace sinew;
using test::Folder;

constexpr std::size_t chunks = 9;
const Digest key{1, 2, 3};

std::vector<std::byte> chunk_of(std::size_t k) {
  std::vector<std::byte> bytes(10 + 37 * k);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 + k);
  return bytes;
}

/// A log of the chunks 0 … count−1, appended backwards.
void write_log(const std::filesystem::path& path, std::size_t count) {
  auto log = ChunkLog::open(path, key, chunks, ChunkLog::Open::create);
  ASSERT_TRUE(log) << to_string(log.error());
  for (std::size_t k = count; k-- > 0;) ASSERT_TRUE(log->append(k, chunk_of(k)));
}

void expect_whole(const ChunkLog& log) {
  std::vector<std::byte> bytes;
  for (std::size_t k = 0; k < chunks; ++k)
    if (log.has(k)) {
      ASSERT_TRUE(log.read(k, bytes));
      EXPECT_EQ(bytes, chunk_of(k));
    }
}

TEST(ChunkLog, HandsBackWhatWasAppended) {
  const Folder folder;
  write_log(folder.path / "log", chunks);
  const auto log = ChunkLog::open(folder.path / "log", key, chunks, ChunkLog::Open::resume);
  ASSERT_TRUE(log);
  EXPECT_EQ(log->count(), chunks);
  expect_whole(*log);
}

TEST(ChunkLog, CutAtAnyByteKeepsTheWholeChunksBefore) {
  const Folder folder;
  const auto path = folder.path / "log";
  write_log(path, 4);
  const std::string whole = test::bytes(path);
  std::size_t last = 0;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    auto log = ChunkLog::open(path, key, chunks, ChunkLog::Open::resume);
    ASSERT_TRUE(log) << size << to_string(log.error());
    EXPECT_GE(log->count(), last);
    last = log->count();
    expect_whole(*log);
    ASSERT_TRUE(log->append(8, chunk_of(8)));  // it goes on behind them
    expect_whole(*log);
  }
  EXPECT_EQ(last, 4U);
}

TEST(ChunkLog, NeverHandsBackAnotherByte) {
  const Folder folder;
  const auto path = folder.path / "log";
  write_log(path, chunks);
  const std::string whole = test::bytes(path);
  std::mt19937 random(7);
  for (int trial = 0; trial < 400; ++trial) {
    std::string damaged = whole;
    const std::size_t at = random() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << random() % 8));
    std::ofstream(path, std::ios::binary) << damaged;
    const auto log = ChunkLog::open(path, key, chunks, ChunkLog::Open::resume);
    if (log) expect_whole(*log);  // else its head is damaged, and it says so
  }
}

TEST(ChunkLog, SeesWhatIsDamagedLater) {
  const Folder folder;
  const auto path = folder.path / "log";
  write_log(path, 3);
  const auto log = ChunkLog::open(path, key, chunks, ChunkLog::Open::resume);
  ASSERT_TRUE(log);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-1, std::ios::end);
  file.put('\x55');
  file.close();
  std::vector<std::byte> bytes;
  EXPECT_FALSE(log->read(0, bytes));  // the last one written
}

TEST(ChunkLog, IsOfOneSweepAndOneProcess) {
  const Folder folder;
  const auto path = folder.path / "log";
  const auto code = [&](const Digest& other, std::size_t count, ChunkLog::Open how) {
    const auto log = ChunkLog::open(path, other, count, how);
    return log ? std::string() : log.error().front().code;
  };
  write_log(path, 2);
  EXPECT_EQ(code(Digest{9}, chunks, ChunkLog::Open::resume), "other_sweep");
  EXPECT_EQ(code(key, chunks + 1, ChunkLog::Open::resume), "other_sweep");
  EXPECT_EQ(code(key, chunks, ChunkLog::Open::create), "sweep_begun");
  {
    const auto held = ChunkLog::open(path, key, chunks, ChunkLog::Open::resume);
    ASSERT_TRUE(held);
    EXPECT_EQ(code(key, chunks, ChunkLog::Open::resume), "in_use");
  }
  std::ofstream(path) << std::string(200, 'x');
  EXPECT_EQ(code(key, chunks, ChunkLog::Open::resume), "not_a_log");
  EXPECT_EQ(test::bytes(path), std::string(200, 'x'));  // someone's file
  EXPECT_FALSE(ChunkLog::open("/dev/full/log", key, chunks, ChunkLog::Open::create));
}

}  // namespace chunk_log_test
