/// What is recorded of a device, and disks that are full, that hang, that break.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "device_desk.hpp"

namespace sinew::server::device {
namespace device_recording_test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Folder {
  explicit Folder(const std::string& name) : path(fs::temp_directory_path() / name) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::istringstream text(text_of(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

void finish(PanelDesk& desk) {
  desk.let_go();
  desk.panel.disarm(desk.secret, desk.now);
  desk.run(1.2);
  desk.recording.wait(std::chrono::seconds(5));
}

TEST(DeviceRecording, StandsAlone) {
  Folder folder("sinew-recording-alone");
  PanelDesk desk(true, folder.path.string());
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(1);
  finish(desk);
  EXPECT_FALSE(desk.recording.is_on());
  const auto lines = lines_of(folder.path / "test.csv");
  ASSERT_GT(lines.size(), 50u);
  EXPECT_EQ(lines[0], "# sinew recording, version 1");
  EXPECT_EQ(lines[1], "# robot: nottingham-tpcj");
  EXPECT_EQ(lines[2], fmt::format("# table: {:08X}", desk.link.hello()->hash));
  std::size_t at = 3;
  while (lines[at].starts_with("#")) ++at;
  EXPECT_TRUE(lines[at].starts_with("time[s],S0_beta_1[rad],S0_beta_2[rad],")) << lines[at];
  EXPECT_TRUE(lines[at].ends_with(",S4_state,event,text")) << lines[at];
  const auto commas = std::ranges::count(lines[at], ',');
  int rows = 0;
  std::string events;
  double before = 0;
  for (++at; at < lines.size(); ++at) {
    EXPECT_FALSE(lines[at].starts_with("#")) << "comments only at the start";
    const double time = std::stod(lines[at]);
    EXPECT_GE(time, before - 1e-9) << lines[at];
    before = time;
    if (lines[at].ends_with(",,")) {
      ++rows;
      EXPECT_EQ(std::ranges::count(lines[at], ','), commas);
      EXPECT_NE(lines[at].find(",1,EXACT,EXACT,EXACT,EXACT,EXACT,,"), std::string::npos) << lines[at];
    } else {
      events += lines[at].substr(lines[at].rfind("EXACT,")) + '\n';
    }
  }
  EXPECT_NEAR(rows, 50 * 2.1, 12) << "a second longer than it was armed";
  EXPECT_EQ(rows, desk.recording.rows());
  EXPECT_NE(events.find("info,\"armed\""), std::string::npos) << events;
  EXPECT_NE(events.find("info,\"disarmed: you disarmed\""), std::string::npos) << events;
}

TEST(DeviceRecording, HasWhatCameAfterDisarming) {
  Folder folder("sinew-recording-tail");
  PanelDesk desk(true, folder.path.string());
  make_ready(desk);
  desk.link.extra_tension[4] = 25;
  desk.run(1.5);
  EXPECT_EQ(desk.panel.why(), "over-tension");
  EXPECT_NE(text_of(folder.path / "test.csv").find(",EXACT,OVER-TENSIONED,EXACT,EXACT,EXACT,,"),
            std::string::npos)
      << "the state that disarmed it";
  EXPECT_NE(
      text_of(folder.path / "test.csv").find(",over,\"S2 OVER-TENSIONED: Pay out tendon 2: over 20 N\"\n"),
      std::string::npos)
      << "in the words of the panel";
}

TEST(DeviceRecording, BeginsWithTheStatesThatThereAre) {
  Folder folder("sinew-recording-before");
  PanelDesk desk(true, folder.path.string());
  desk.link.extra_tension[9] = -5;
  desk.run(0.3);
  make_ready(desk);
  finish(desk);
  const auto lines = lines_of(folder.path / "test.csv");
  const auto columns =
      std::ranges::find_if(lines, [](const auto& line) { return line.starts_with("time[s]"); });
  ASSERT_GT(lines.end() - columns, 1);
  EXPECT_TRUE(columns[1].ends_with(
      ",EXACT,EXACT,EXACT,PARTLY SLACK,EXACT,slack,\"S4 PARTLY SLACK: Look at tendon 1: no tension\""))
      << columns[1];
}

TEST(DeviceRecording, AFieldIsOneLineInQuotes) {
  EXPECT_EQ(quoted("a \"b\"\r\nc\t#,"), "\"a \"\"b\"\"  c #,\"");
  EXPECT_EQ(quoted(""), "\"\"");
}

TEST(DeviceRecording, ARobotsTextStaysAComment) {
  Folder folder("sinew-recording-text");
  Recording recording(folder.path, "name: x\r\n\n# its own\n0,1,2\nlast");
  recording.begin("a", {"two\nlines", 1, "lsk", 0, ",b,event,text"}, 5);
  recording.row(5.5, ",1,,");
  recording.end();
  recording.wait(std::chrono::seconds(5));
  std::string text = text_of(folder.path / "a.csv");
  text.erase(text.find("# date"), text.find("# file") - text.find("# date"));
  EXPECT_EQ(text,
            "# sinew recording, version 1\n# robot: two lines\n# table: 00000001\n# model: lsk\n# file:\n"
            "#   name: x \n#\n#   # its own\n#   0,1,2\n#   last\ntime[s],b,event,text\n0.500,1,,\n");
}

TEST(DeviceRecording, NeverGoesOnInAFileThatIsThere) {
  Folder folder("sinew-recording-there");
  std::ofstream(folder.path / "test.csv") << "something\n";
  PanelDesk desk(true, folder.path.string());
  desk.take_control();
  EXPECT_EQ(desk.arm(), "");
  EXPECT_EQ(desk.panel.mode(), Mode::control);
  EXPECT_NE(desk.panel.why().find("there is a recording of this name"), std::string::npos)
      << desk.panel.why();
  EXPECT_EQ(desk.arm(), "");
  EXPECT_EQ(desk.panel.mode(), Mode::armed) << "under another name";
  EXPECT_EQ(text_of(folder.path / "test.csv"), "something\n");
}

TEST(DeviceRecording, WithoutAFolderNothingIsArmed) {
  PanelDesk desk(true, "/proc/sinew-recordings");
  desk.take_control();
  EXPECT_EQ(desk.arm(), "");
  desk.run(1);
  EXPECT_EQ(desk.panel.mode(), Mode::control);
  EXPECT_FALSE(desk.link.verbs.find('A') != std::string::npos) << "the controller was not even asked";
}

TEST(DeviceRecording, AFullDiskArmsNothing) {
  Folder folder("sinew-recording-full");
  fs::create_symlink("/dev/full", folder.path / "test.csv");
  PanelDesk desk(true, folder.path.string());
  desk.take_control();
  EXPECT_EQ(desk.arm(), "");
  EXPECT_EQ(desk.panel.mode(), Mode::control);
  EXPECT_EQ(desk.panel.why(), "the recording cannot be written: No space left on device");
  EXPECT_EQ(desk.panel.frame(desk.now)["recording"]["error"], "No space left on device");
  EXPECT_EQ(desk.link.verbs.find('A'), std::string::npos);
  EXPECT_EQ(desk.arm(), "") << "there is room for another one";
  EXPECT_EQ(desk.panel.mode(), Mode::armed);
}

/// One that somebody reads, until he does not.
struct Pipe {
  explicit Pipe(const fs::path& path) {
    EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
    EXPECT_GE(reader, 0);
  }
  ~Pipe() { leave(); }
  void leave() {
    if (reader >= 0) ::close(reader);
    reader = -1;
  }
  int reader;
};

TEST(DeviceRecording, OneThatBreaksHoldsTheMotion) {
  Folder folder("sinew-recording-breaks");
  Pipe pipe(folder.path / "test.csv");
  PanelDesk desk(true, folder.path.string());
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.3);
  EXPECT_EQ(desk.panel.activity(), Activity::moving);
  pipe.leave();
  const double broken = desk.now;
  desk.run(0.4);
  EXPECT_LT(desk.link.moved - broken, 0.15);
  EXPECT_EQ(desk.panel.activity(), Activity::holding);
  EXPECT_EQ(desk.panel.frame(desk.now)["recording"]["error"], "Broken pipe");
  desk.let_go();
  desk.run(0.4);
  EXPECT_EQ(desk.press(Activity::moving), "recording");
}

/// As a disk that is full amid a row: no file may grow beyond this size.
struct SizeLimit {
  explicit SizeLimit(rlim_t size) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit limit{size, before.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  ~SizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before); }
  rlimit before{};
};

TEST(DeviceRecording, ADiskThatIsFullAmidARowHoldsTheMotionAndKeepsWholeRows) {
  Folder folder("sinew-recording-amid");
  PanelDesk desk(true, folder.path.string());
  make_ready(desk);
  desk.press(Activity::moving);
  desk.run(0.3);
  EXPECT_EQ(desk.panel.activity(), Activity::moving);
  {
    const SizeLimit limit(fs::file_size(folder.path / "test.csv") + 100);
    desk.run(0.4);
  }
  EXPECT_EQ(desk.panel.activity(), Activity::holding);
  EXPECT_EQ(desk.panel.mode(), Mode::armed) << "the drives stay where they are";
  EXPECT_EQ(desk.panel.frame(desk.now)["recording"]["error"], "File too large");
  EXPECT_TRUE(text_of(folder.path / "test.csv").ends_with(",EXACT,EXACT,EXACT,EXACT,EXACT,,\n"));
  desk.let_go();
  desk.run(0.4);
  EXPECT_EQ(desk.press(Activity::moving), "recording");
  desk.let_go();
  desk.panel.disarm(desk.secret, desk.now);
  desk.run(0.4);
  EXPECT_EQ(desk.arm(), "") << "there is room again";
  EXPECT_EQ(desk.panel.mode(), Mode::armed);
}

/// A pipe that takes 64 KiB and then no more, as a disk that hangs.
TEST(DeviceRecording, OneThatHangsStallsNobodyAndHoldsTheMotion) {
  Folder folder("sinew-recording-hangs");
  const Pipe pipe(folder.path / "test.csv");
  PanelDesk desk(true, folder.path.string());
  make_ready(desk);
  desk.has_disk = false;
  desk.press(Activity::moving);
  Clock::duration slowest{};
  double held = 0;
  for (int i = 0; i < 3000 && held == 0; ++i) {
    const auto begin = Clock::now();
    desk.run(2e-3);
    slowest = std::max(slowest, Clock::now() - begin);
    if (desk.panel.frame(desk.now)["recording"]["error"] != "") held = desk.now;
    if (desk.panel.activity() != Activity::moving)
      desk.go_to(bent(i % 2 ? 0.2 : -0.2)), desk.press(Activity::moving);
  }
  ASSERT_GT(held, 0) << "all of it went into the pipe: " << desk.recording.rows();
  EXPECT_LT(slowest, std::chrono::milliseconds(250)) << "of one turn of the loop";
  EXPECT_EQ(desk.panel.frame(desk.now)["recording"]["error"], "the disk takes nothing any more");
  desk.run(0.2);
  EXPECT_NE(desk.panel.activity(), Activity::moving);
  desk.let_go();
  desk.run(0.4);
  EXPECT_EQ(desk.press(Activity::moving), "recording");
  desk.panel.disarm(desk.secret, desk.now);
  EXPECT_EQ(desk.code(desk.panel.arm(desk.secret, desk.now)), "recording") << "the disk still hangs";
}

/// Opening a pipe waits until somebody reads it.
TEST(DeviceRecording, OneThatNeverOpensArmsNothing) {
  Folder folder("sinew-recording-never");
  ASSERT_EQ(::mkfifo((folder.path / "test.csv").c_str(), 0600), 0);
  const auto begin = Clock::now();
  {
    PanelDesk desk(true, folder.path.string());
    desk.has_disk = false;
    desk.take_control();
    EXPECT_EQ(desk.arm(), "");
    desk.run(1.5);
    EXPECT_EQ(desk.panel.mode(), Mode::control);
    EXPECT_EQ(desk.panel.why(), "the disk did not take the recording");
    EXPECT_EQ(desk.link.verbs.find('A'), std::string::npos);
  }
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(20)) << "it is left alone in the end";
}

TEST(DeviceRecording, PicturesAreKeptBesideIt) {
  Folder folder("sinew-recording-pictures");
  PanelDesk desk(true, folder.path.string());
  std::string name;
  EXPECT_EQ(desk.code(desk.panel.keep_picture("picture", "jpg", "", name)), "no_recording");
  make_ready(desk);
  EXPECT_EQ(desk.code(desk.panel.keep_picture("first", "jpg", "at the \"blade\"\n,x", name)), "");
  EXPECT_EQ(name, "test-001.jpg");
  EXPECT_EQ(desk.code(desk.panel.keep_picture("second", "png", "", name)), "");
  EXPECT_EQ(name, "test-002.png");
  finish(desk);
  EXPECT_EQ(text_of(folder.path / "test-001.jpg"), "first");
  EXPECT_EQ(text_of(folder.path / "test-002.png"), "second");
  const std::string text = text_of(folder.path / "test.csv"),
                    table = fmt::format("{:08X}", desk.link.hello()->hash);
  EXPECT_NE(text.find(",snapshot,\"test-001.jpg, table " + table + ": at the \"\"blade\"\" ,x\"\n"),
            std::string::npos);
  EXPECT_NE(text.find(",snapshot,\"test-002.png, table " + table + "\"\n"), std::string::npos);
}

TEST(DeviceRecording, PicturesThatWaitAreBounded) {
  Folder folder("sinew-recording-bound");
  ASSERT_EQ(::mkfifo((folder.path / "a.csv").c_str(), 0600), 0);
  Recording recording(folder.path);
  recording.begin("a", {"x", 1, "lsk", 0, ""}, 0);
  const std::string large(std::size_t{8} << 20U, 'x');
  int kept = 0;
  while (kept < 10 && !recording.picture(large, "jpg").empty()) ++kept;
  EXPECT_EQ(kept, 2);
  recording.row(1, "");
  EXPECT_EQ(recording.error(), "") << "rows still find room";
}

}  // namespace device_recording_test
}  // namespace sinew::server::device
